"""The boundary of the shadow along a ray (figure 3.2)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import BLUE, ORANGE
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.drawing.style import GRID, legend_below, write_figure
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.scene_figures import SceneFigure


class Settings(SceneFigure):
    """A light's rays in a slice, with their bounds [figure 3.2]."""

    kind: Literal["shadow_boundary"] = Field(description="`shadow_boundary`")


def files(layout: Layout, figure: str) -> dict[str, Any]:
    scene, paths = layout.entry("figures", figure)["scene"], layout.paths
    return {
        "mesh_ply": paths.scene("mesh.ply", scene),
        "mesh_json": paths.scene("mesh.json", scene),
    }


def params(layout: Layout, figure: str) -> dict[str, Any]:
    scene = layout.entry("figures", figure)["scene"]
    return {"scene": layout.entry("scenes", scene)["scene"]}


def draw(
    mesh_ply: Path,
    mesh_json: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: Mapping[str, Any],
) -> None:
    """Draw a light's rays in a slice, and their bounds over the offset across the light."""
    from neural_shadows.reports.drawing import drawing
    from neural_shadows.reports.drawing.mesh_slice import slice_rays

    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title)
    plane, graph = figure.subplots(1, 2)
    drawing.draw_disk(plane, "the slice, lit from the upper left")
    rays = slice_rays(cut, 1200)
    hit, end = rays.hit, rays.end
    parts = (
        (rays.t_lb, end, BLUE, "between first and second hit: t$_s$ may lie anywhere"),
        (end, rays.chord, drawing.SHADE, "in shadow"),
    )
    for begin, stop, colour, label in parts:
        lines = rays.at(begin)[hit], rays.at(stop)[hit]
        drawing.draw_segments(plane, *lines, colors=colour, linewidths=0.5, rasterized=True)
        stop = np.where(hit, stop, begin)
        graph.fill_between(rays.offset, begin, stop, color=colour, lw=0, label=label)
    drawing.draw_outline(plane, cut)
    few = slice_rays(cut, 12)
    drawing.draw_segments(plane, few.at(0 * few.t_lb), few.at(few.t_lb), colors=ORANGE)
    graph.plot(rays.offset, rays.chord, color=ORANGE, label="bounding sphere and light")
    graph.set(xlabel="offset of the ray across the light", ylabel="depth t along the ray")
    graph.set_title("the same by depth: a boundary t$_s$ within the blue is right", fontsize=11)
    graph.grid(**GRID)
    legend_below(figure)
    write_figure(figure, png, svg)


if "snakemake" in globals():
    run_stage(snakemake, draw)
