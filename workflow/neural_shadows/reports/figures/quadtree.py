"""A silhouette with its quadtree (figure 3.5)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from neural_shadows.reports.figures.drawing import (
    SHOWN_POINTS,
    SilhouetteDrawing,
    draw_disk,
    method_figure,
    open_slice,
)
from neural_shadows.reports.figures.style import write_figure
from neural_shadows.running.stage import run_stage


def draw(
    mesh_ply: Path,
    mesh_json: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: Mapping[str, Any],
    sampling: Mapping[str, Any],
    seed: int,
) -> None:
    """Draw a silhouette's quadtree, and points divided over its quads."""
    cut, figure = open_slice(mesh_ply, scene), method_figure(title, mesh_json)
    shown = SilhouetteDrawing(cut, sampling, seed, SHOWN_POINTS)
    left, right = figure.subplots(1, 2)
    quads = f"quadtree of {len(shown.quads):,} quads"
    draw_disk(left, f"silhouette of {shown.resolution}² texels, {quads}")
    shown.draw(left)
    shown.draw_quads(left)
    draw_disk(right, f"{SHOWN_POINTS:,} points, divided evenly over the quads")
    shown.draw(right)
    shown.draw_points(right, 3)
    write_figure(figure, png, svg)


if "snakemake" in globals():
    run_stage(snakemake, draw)
