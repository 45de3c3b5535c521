"""The two bounds of a label (figure 3.6)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from neural_shadows.reports.figures.drawing import (
    BLUE,
    FEW_RAYS,
    ORANGE,
    SHADE,
    _plane,
    _rays_with_bounds,
    draw_outline,
)
from neural_shadows.reports.figures.mesh_slice import MeshSlice, slice_rays

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _dual_bounds(figure: Figure, cut: MeshSlice) -> None:
    from matplotlib.lines import Line2D

    whole, part = figure.subplots(1, 2)
    rays = slice_rays(cut, FEW_RAYS)
    dense = slice_rays(cut, 8 * FEW_RAYS)
    _plane(whole, f"{FEW_RAYS} of a light's rays")
    _plane(part, "the middle, with more rays")
    part.set_xlim(-0.4, 0.4)
    part.set_ylim(-0.4, 0.4)
    for axes, shown in ((whole, rays), (part, dense)):
        _rays_with_bounds(axes, shown, 1.2)
        draw_outline(axes, cut)
    figure.legend(
        handles=[
            Line2D([], [], color=ORANGE, label="lit: up to t$_{lb}$, the first hit or the sphere"),
            Line2D([], [], color=BLUE, linewidth=4, label="t$_{lb}$ to t$_{ub}$, the second hit"),
            Line2D([], [], color=SHADE, label="in shadow"),
        ],
        loc="outside lower center",
        ncols=3,
    )
