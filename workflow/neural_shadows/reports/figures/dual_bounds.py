"""The two bounds of a label (figure 3.5)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from neural_shadows.layout.layout import Layout
from neural_shadows.reports.drawing.style import legend_below, write_figure
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.scene_figures import SceneFigure


class Settings(SceneFigure):
    """Rays of a slice, coloured by their bounds [figure 3.5]."""

    kind: Literal["dual_bounds"] = Field(description="`dual_bounds`")


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
    """Draw some of a light's rays in a slice, coloured by their bounds."""
    from neural_shadows.reports.drawing import drawing
    from neural_shadows.reports.drawing.mesh_slice import slice_rays

    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title)
    whole, part = figure.subplots(1, 2)
    drawing.draw_disk(whole, f"{drawing.FEW_RAYS} of a light's rays")
    drawing.draw_disk(part, "the middle, with more rays")
    part.set(xlim=(-0.4, 0.4), ylim=(-0.4, 0.4))
    for axes, count in ((whole, drawing.FEW_RAYS), (part, 8 * drawing.FEW_RAYS)):
        drawing.draw_bounded_rays(axes, slice_rays(cut, count), 1.2)
        drawing.draw_outline(axes, cut)
    legend_below(figure)
    write_figure(figure, png, svg)


if "snakemake" in globals():
    run_stage(snakemake, draw)
