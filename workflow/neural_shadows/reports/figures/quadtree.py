"""A silhouette with its quadtree (figure 3.5)."""

from pathlib import Path

from neural_shadows.reports.figures import drawing
from neural_shadows.reports.figures.style import Section, note_below, write_figure
from neural_shadows.running.stage import run_stage


def draw(
    mesh_ply: Path,
    mesh_json: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: Section,
    sampling: Section,
    seed: int,
) -> None:
    """Draw a silhouette's quadtree, and points divided over its quads."""
    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title)
    shown = drawing.slice_silhouette(cut, sampling)
    left, right = figure.subplots(1, 2)
    quads = f"quadtree of {len(shown.quads):,} quads"
    drawing.draw_disk(left, f"silhouette of {shown.resolution}² texels, {quads}")
    shown.draw(left)
    drawing.draw_disk(right, f"{drawing.SHOWN_POINTS:,} points, divided evenly over the quads")
    shown.draw(right, quads=False)
    shown.draw_points(right, drawing.SHOWN_POINTS, seed, 3)
    note_below(
        figure,
        "Grey: what the object covers, seen across the slice. Blue: squares, divided where its "
        "outline runs.\nOrange: the bounding sphere. So most rays start where shadow meets light.",
    )
    write_figure(figure, png, svg)


if "snakemake" in globals():
    run_stage(snakemake, draw)
