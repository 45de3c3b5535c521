"""The boundary of the shadow along a ray (figure 3.2)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.patches import Patch

from neural_shadows.reports.figures import drawing
from neural_shadows.reports.figures.mesh_slice import slice_rays
from neural_shadows.reports.figures.style import BLUE, GRID, ORANGE, legend_below, write_figure
from neural_shadows.running.stage import run_stage


def draw(
    mesh_ply: Path, mesh_json: Path, png: Path, svg: Path, *, title: str, scene: Mapping[str, Any]
) -> None:
    """Draw a light's rays in a slice, and their bounds over the offset across the light."""
    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title)
    plane, graph = figure.subplots(1, 2)
    drawing.draw_disk(plane, "the slice, lit from the upper left")
    rays = slice_rays(cut, 1200)
    hit, end = rays.hit, rays.end
    parts = ((end, rays.chord, drawing.SHADE), (rays.t_lb, end, BLUE))
    for begin, stop, colour in parts:
        lines = rays.at(begin)[hit], rays.at(stop)[hit]
        drawing.draw_segments(plane, *lines, colors=colour, linewidths=0.5, rasterized=True)
        graph.fill_between(rays.offset, begin, np.where(hit, stop, begin), color=colour, lw=0)
    drawing.draw_outline(plane, cut)
    few = slice_rays(cut, 12)
    drawing.draw_segments(
        plane, few.at(np.zeros(12)), few.at(few.t_lb), colors=ORANGE, linewidths=1
    )
    graph.plot(rays.offset, rays.chord, color=ORANGE, linewidth=1.2)
    graph.set_xlabel("offset of the ray across the light")
    graph.set_ylabel("depth t along the ray, from the sphere")
    graph.set_title("the same by depth: a boundary t$_s$ within the blue is right", fontsize=11)
    graph.grid(**GRID)
    legend_below(
        figure,
        [
            Patch(color=BLUE, label="between first and second hit: t$_s$ may lie anywhere"),
            Patch(color=drawing.SHADE, label="in shadow"),
            Patch(color=ORANGE, label="bounding sphere and light"),
        ],
    )
    write_figure(figure, png, svg)


if "snakemake" in globals():
    run_stage(snakemake, draw)
