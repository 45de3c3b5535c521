"""The boundary of the shadow along a ray (figure 3.2)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.reports.figures.drawing import (
    BLUE,
    ORANGE,
    SHADE,
    _plane,
    _segments,
    draw_outline,
)
from neural_shadows.reports.figures.mesh_slice import MeshSlice, slice_rays

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _shadow_boundary(figure: Figure, cut: MeshSlice) -> None:
    from matplotlib.patches import Patch

    plane, graph = figure.subplots(1, 2)
    rays = slice_rays(cut, 1200)
    hit = rays.hit
    end = np.minimum(rays.t_ub, rays.chord)
    _plane(plane, "the slice, lit from the upper left")
    width = 0.5
    _segments(
        plane,
        rays.at(end)[hit],
        rays.at(rays.chord)[hit],
        colors=SHADE,
        linewidths=width,
        rasterized=True,
    )
    _segments(
        plane,
        rays.at(rays.t_lb)[hit],
        rays.at(end)[hit],
        colors=BLUE,
        linewidths=width,
        rasterized=True,
    )
    draw_outline(plane, cut)
    few = slice_rays(cut, 12)
    _segments(plane, few.at(np.zeros(12)), few.at(few.t_lb), colors=ORANGE, linewidths=1)
    graph.fill_between(rays.offset, rays.chord, np.where(hit, end, rays.chord), color=SHADE)
    graph.fill_between(
        rays.offset, rays.t_lb, np.where(hit, end, rays.t_lb), color=BLUE, linewidth=0
    )
    graph.plot(rays.offset, rays.chord, color=ORANGE, linewidth=1.2)
    graph.set_xlabel("offset of the ray across the light")
    graph.set_ylabel("depth t along the ray, from the sphere")
    graph.set_title("the same by depth: a boundary t$_s$ within the blue is right", fontsize=11)
    graph.grid(linewidth=0.4, alpha=0.4)
    figure.legend(
        handles=[
            Patch(color=BLUE, label="between first and second hit: t$_s$ may lie anywhere"),
            Patch(color=SHADE, label="in shadow"),
            Patch(color=ORANGE, label="bounding sphere and light"),
        ],
        loc="outside lower center",
        ncols=3,
    )
