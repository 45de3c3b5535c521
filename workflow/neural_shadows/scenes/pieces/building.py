"""Shared parts of buildings in metres; y is up."""

import numpy as np

from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    beams,
    box,
    boxes,
    copies,
    joined,
    lathe,
    prisms,
    sheet,
)


def floor(width: float, depth: float) -> Shape:
    """A floor about the origin, `width` along x."""
    return sheet((-width / 2, -depth / 2), (width / 2, depth / 2))


def walls(width: float, depth: float, height: float, thickness: float = 0.1) -> Shape:
    """Four walls around a floor of width × depth."""
    w, d, t = width / 2, depth / 2, thickness
    lows = [[-w - t, 0, -d - t], [-w - t, 0, d], [-w - t, 0, -d], [w, 0, -d]]
    highs = [[w + t, height, -d], [w + t, height, d + t], [-w, height, d], [w + t, height, d]]
    return boxes(lows, highs)


def column(height: float, radius: float = 0.2) -> Shape:
    """A round column with a square base and capital."""
    r, side = radius, 1.5 * radius
    shaft = [(0, 0.12), (1.35 * r, 0.12), (1.4 * r, 0.18), (1.1 * r, 0.24), (r, 0.3)]
    shaft += [(1.04 * r, 0.4 * height), (0.85 * r, height - 0.35), (0.95 * r, height - 0.32)]
    shaft += [(0.85 * r, height - 0.28), (1.35 * r, height - 0.12), (0, height - 0.12)]
    return joined(
        box((-side, 0, -side), (side, 0.12, side)),
        lathe(shaft, 32),
        box((-side, height - 0.12, -side), (side, height, side)),
    )


def arcade(bays: int, span: float, spring: float, top: float, thickness: float = 0.4) -> Shape:
    """Round arches along x between column centres, with level top.

    Args:
        span: of a bay, between columns' middles. spring: height where the arches begin.
    """
    radius, angle = span / 2 - 0.2, np.linspace(np.pi, 0, 17)
    x, y = radius * np.cos(angle), spring + radius * np.sin(angle)
    x, y = np.r_[-span / 2, x, span / 2], np.r_[spring, y, spring]
    low, high = np.stack([x, y], axis=1), np.stack([x, np.full_like(x, top)], axis=1)
    bay = prisms(np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1), thickness)
    middles = (np.arange(bays) - (bays - 1) / 2) * span
    return joined(*(at(bay, (middle, 0, 0)) for middle in middles))


def balustrade(start, end, height: float = 0.95, apart: float = 0.16) -> Shape:
    """Turned balusters between two rails, from point to point."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    level = np.linalg.norm((end - start)[[0, 2]])
    count = max(2, round(level / apart))
    h = height - 0.1
    profile = [(0, 0), (0.03, 0), (0.03, 0.08), (0.016, 0.13), (0.035, 0.3 * h), (0.018, 0.55 * h)]
    profile += [(0.014, 0.8 * h), (0.028, h - 0.08), (0.028, h), (0, h)]
    feet = start + ((np.arange(count) + 0.5) / count)[:, None] * (end - start)
    transforms = np.tile(np.eye(4), (count, 1, 1))
    transforms[:, :3, 3] = feet + [0, 0.04, 0]
    rails = np.array([[start, start], [end, end]]) + [[0, 0.03, 0], [0, height - 0.03, 0]]
    return joined(copies(lathe(profile, 8), transforms), beams(*rails, 0.09, 0.06))


def window_wall(width: float, height: float, windows: int, *, sill=0.9, top=2.3, opening=1.2):
    """A wall along x with framed windows, z from −0.1 to 0."""
    middles = (np.arange(windows) + 0.5) / windows * width - width / 2
    edges = np.r_[-width / 2, np.ravel([middles - opening / 2, middles + opening / 2], "F")]
    edges = np.r_[edges, width / 2]
    piers = boxes([[x, sill, -0.1] for x in edges[::2]], [[x, top, 0] for x in edges[1::2]])
    ends = width / 2
    below = box((-ends, 0, -0.1), (ends, sill, 0))
    above = box((-ends, top, -0.1), (ends, height, 0))
    frame = at(window_frame(opening, top - sill), (0, sill, -0.05))
    board = box((-opening / 2 - 0.06, sill, 0), (opening / 2 + 0.06, sill + 0.025, 0.16))
    bays = [at(joined(frame, board), (middle, 0, 0)) for middle in middles]
    return joined(piers, below, above, *bays)


def window_frame(width: float, height: float, bar: float = 0.04) -> Shape:
    """An upright window frame with a cross bar and two mullions."""
    x, b = width / 2, bar / 2
    xs, ys = [-x + b, -x / 3, x / 3, x - b], [b, 2 * height / 3, height - b]
    upright = boxes([[c - b, 0, -b] for c in xs], [[c + b, height, b] for c in xs])
    level = boxes([[-x, c - b, -0.8 * b] for c in ys], [[x, c + b, 0.8 * b] for c in ys])
    return joined(upright, level)


def flight(steps: int, width: float, rise: float = 0.17, going: float = 0.28) -> Shape:
    """Closed steps along +x from the origin, `width` along z."""
    k = np.arange(steps)[:, None]
    lows = k * [going, 0, 0] + [0, 0, -width / 2]
    highs = k * [going, rise, 0] + [going, rise - 0.03, width / 2]
    treads = boxes(
        k * [going, rise, 0] + [-0.025, rise - 0.03, -width / 2 - 0.02],
        k * [going, rise, 0] + [going, rise, width / 2 + 0.02],
    )
    return joined(boxes(lows, highs), treads)
