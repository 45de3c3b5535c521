"""The two bounds of a label (figure 3.6)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.lines import Line2D

from neural_shadows.reports.figures import drawing
from neural_shadows.reports.figures.mesh_slice import slice_rays
from neural_shadows.reports.figures.style import BLUE, ORANGE, legend_below, write_figure
from neural_shadows.running.stage import run_stage


def draw(
    mesh_ply: Path, mesh_json: Path, png: Path, svg: Path, *, title: str, scene: Mapping[str, Any]
) -> None:
    """Draw some of a light's rays in a slice, coloured by their bounds."""
    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title)
    whole, part = figure.subplots(1, 2)
    drawing.draw_disk(whole, f"{drawing.FEW_RAYS} of a light's rays")
    drawing.draw_disk(part, "the middle, with more rays")
    part.set(xlim=(-0.4, 0.4), ylim=(-0.4, 0.4))
    for axes, count in ((whole, drawing.FEW_RAYS), (part, 8 * drawing.FEW_RAYS)):
        drawing.draw_bounded_rays(axes, slice_rays(cut, count), 1.2)
        drawing.draw_outline(axes, cut)
    legend_below(
        figure,
        [
            Line2D([], [], color=ORANGE, label="lit: up to t$_{lb}$, the first hit or the sphere"),
            Line2D([], [], color=BLUE, linewidth=4, label="t$_{lb}$ to t$_{ub}$, the second hit"),
            Line2D([], [], color=drawing.SHADE, label="in shadow"),
        ],
    )
    write_figure(figure, png, svg)


if "snakemake" in globals():
    run_stage(snakemake, draw)
