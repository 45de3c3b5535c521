"""A silhouette with its quadtree (figure 3.5)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from neural_shadows.reports.figures.drawing import (
    SHOWN_POINTS,
    _plane,
    _points,
    _points_of,
    _quads,
    _silhouette,
)
from neural_shadows.reports.figures.mesh_slice import MeshSlice

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _quadtree(figure: Figure, cut: MeshSlice, sampling: Mapping[str, Any], seed: int) -> None:
    covered, quads, offsets, resolution = _points_of(cut, sampling, seed, SHOWN_POINTS)
    left, right = figure.subplots(1, 2)
    _plane(left, f"silhouette of {resolution}² texels, quadtree of {len(quads):,} quads")
    _silhouette(left, cut, covered)
    _quads(left, cut, quads, resolution)
    _plane(right, f"{SHOWN_POINTS:,} points, divided evenly over the quads")
    _silhouette(right, cut, covered)
    _points(right, cut, offsets, 3)
