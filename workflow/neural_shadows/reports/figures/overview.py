"""The method in one picture (figure 3.1)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from neural_shadows.reports.figures.drawing import (
    BLUE,
    FEW_RAYS,
    ORANGE,
    OUTLINE,
    SHADE,
    SHOWN_POINTS,
    _drawn,
    _hemisphere,
    _plane,
    _points,
    _points_of,
    _quads,
    _rays_with_bounds,
    _silhouette,
    draw_outline,
)
from neural_shadows.reports.figures.mesh_slice import MeshSlice, slice_rays

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _overview(figure: Figure, cut: MeshSlice, sampling: Mapping[str, Any], seed: int) -> None:
    from matplotlib.patheffects import withStroke

    directions, points, labels, query = figure.subplots(1, 4)
    _hemisphere(directions, _drawn("poisson_quadtree", seed), "a  view directions")
    covered, quads, offsets, resolution = _points_of(cut, sampling, seed, SHOWN_POINTS // 3)
    _plane(points, "b  rays through a silhouette's quadtree")
    _silhouette(points, cut, covered)
    _quads(points, cut, quads, resolution)
    _points(points, cut, offsets, 2)
    _plane(labels, "c  labels: bounds along the rays")
    _rays_with_bounds(labels, slice_rays(cut, FEW_RAYS), 1.0)
    draw_outline(labels, cut)
    _plane(query, "d  a query: p is in shadow, as s > t$_s$")
    draw_outline(query, cut)
    rays = slice_rays(cut, 401)
    # The ray whose parts before, in and behind the object are all long enough to be seen.
    end = np.minimum(rays.t_ub, rays.chord)
    shortest = np.minimum(rays.t_lb, np.minimum(end - rays.t_lb, rays.chord - end))
    i = int(np.argmax(np.where(rays.hit, shortest, -1)))
    o, d = rays.origins[i], rays.direction
    first, last = float(rays.t_lb[i]), float(min(rays.t_ub[i], rays.chord[i]))
    depth, s = (first + last) / 2, last + 0.6 * (float(rays.chord[i]) - last)
    for begin, end, colour in ((0, depth, ORANGE), (depth, s, SHADE)):
        query.plot(*np.stack([o + begin * d, o + end * d]).T, color=colour, linewidth=2)
    query.plot(*np.stack([o - 0.2 * d, o]).T, color=ORANGE, linewidth=2, linestyle=":")
    query.annotate("light", o - 0.26 * d, ha="center", va="center", color=ORANGE)
    query.set_xlim(-1.25, 1.25)
    query.set_ylim(-1.25, 1.25)
    side = 0.13 * np.array([-d[1], d[0]])
    for t, text, colour in ((0.0, "o", ORANGE), (depth, "t$_s$", BLUE), (s, "p", OUTLINE)):
        query.plot(*(o + t * d), "o", color=colour, zorder=4)
        query.annotate(
            text,
            o + t * d + side,
            ha="center",
            va="center",
            fontsize=12,
            zorder=5,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )
