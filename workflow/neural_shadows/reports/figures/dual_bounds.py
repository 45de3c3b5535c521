"""The two bounds of a label (figure 3.6)."""

from pathlib import Path

from neural_shadows.reports.figures import drawing
from neural_shadows.reports.figures.mesh_slice import slice_rays
from neural_shadows.reports.figures.style import Section, legend_below, write_figure
from neural_shadows.running.stage import run_stage


def draw(
    mesh_ply: Path, mesh_json: Path, png: Path, svg: Path, *, title: str, scene: Section
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
    legend_below(figure)
    write_figure(figure, png, svg)


if "snakemake" in globals():
    run_stage(snakemake, draw)
