"""Shared furniture in metres, standing on y = 0."""

import numpy as np

from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    bars,
    beams,
    box,
    boxes,
    joined,
    lathe,
    leaves,
)

SEAT = 0.45  # height of a chair's seat


def table(width: float, depth: float, height: float = 0.75, leg: float = 0.025) -> Shape:
    """A table, `width` along x, with legs of radius `leg`."""
    x, z = width / 2 - 0.07, depth / 2 - 0.07
    feet = np.array([[-x, 0, -z], [x, 0, -z], [x, 0, z], [-x, 0, z]])
    under = height - 0.04
    rails = feet + [0, under - 0.04, 0]
    return joined(
        box((-width / 2, under, -depth / 2), (width / 2, height, depth / 2)),
        bars(feet, feet + [0, under, 0], leg, sections=16),
        beams(rails, np.roll(rails, -1, axis=0), 0.02, 0.06),
    )


def chair(slats: int = 7) -> Shape:
    """A slatted chair facing +z, 0.42 wide."""
    x = 0.19
    feet = np.array([[-x, 0, x], [x, 0, x], [x, 0, -x], [-x, 0, -x]])
    knees = feet + [0, SEAT - 0.02, 0]
    tops = feet[2:] + [0, 0.92, -0.06]
    at_seat = feet + [0, SEAT - 0.035, 0]
    low = feet + [0, 0.18, 0]
    z = np.linspace(-x, x, slats)[:, None] * [0, 0, 1]
    across = np.linspace(-x, x, slats)[1:-1, None] * [1, 0, 0]
    back_low, back_high = [0, SEAT + 0.08, -x - 0.01], [0, 0.88, -x - 0.055]
    seat_left = z + [-x - 0.02, SEAT - 0.01, 0]
    ends = [[-x, *back_low[1:]], [-x, *back_high[1:]]]
    return joined(
        bars(feet, knees, 0.016, sections=12),
        bars(knees[2:], tops, 0.016, sections=12),
        beams(at_seat, np.roll(at_seat, -1, axis=0), 0.02, 0.03),
        bars(low[[0, 1, 3]], low[[3, 2, 2]], 0.009, sections=8),
        beams(seat_left, seat_left + [2 * x + 0.04, 0, 0], 0.042, 0.02),
        bars(across + back_low, across + back_high, 0.01, sections=8),
        bars(ends, np.array(ends) * [-1, 1, 1], 0.014, sections=8),
    )


def shelf(rng: np.random.Generator, width: float, height: float, boards: int = 5) -> Shape:
    """A bookshelf facing +z, `width` along x, 0.3 deep."""
    x, z, t = width / 2, 0.15, 0.02
    ys = np.linspace(0.06, height - t, boards)
    sides = boxes([[-x, 0, -z], [x - t, 0, -z]], [[-x + t, height, z], [x, height, z]])
    levels = boxes([[-x + t, y, -z + 0.01] for y in ys], [[x - t, y + t, z - 0.005] for y in ys])
    back = box((-x + t, 0.06, -z), (x - t, height, -z + 0.01))
    room = ys[1] - ys[0] - t
    rows = [at(books(rng, width - 2 * t - 0.04, room), (0, y + t, -0.02)) for y in ys[:-1]]
    return joined(sides, levels, back, *rows)


def books(rng: np.random.Generator, width: float, height: float) -> Shape:
    """A row of upright books along x, up to `height`."""
    lows, highs, x = [], [], -width / 2
    while x < width / 2 - 0.06:
        thick, tall = rng.uniform(0.015, 0.05), height * rng.uniform(0.55, 0.93)
        depth = rng.uniform(0.07, 0.12)
        lows.append([x, 0, -0.11])
        highs.append([x + thick, tall, depth])
        x += thick + (rng.uniform(0.05, 0.2) if rng.random() < 0.12 else 0.001)
    return boxes(lows, highs)


def plant(rng: np.random.Generator, height: float, quads: int = 150) -> Shape:
    """A potted plant of `quads` folded leaves on curved stems."""
    pot = lathe(
        [(0, 0), (0.11, 0), (0.15, 0.26), (0.17, 0.28), (0.15, 0.28), (0.14, 0.25), (0, 0.25)]
    )
    stems = max(4, quads // 12)
    turn = rng.uniform(0, 2 * np.pi, stems)
    lean, top = rng.uniform(0.05, 0.35, stems), rng.uniform(0.6, 0.95, stems) * height
    out = np.stack([np.cos(turn), np.zeros(stems), np.sin(turn)], axis=1)
    share = np.linspace(0, 1, 7)[:, None, None]
    paths = 0.04 * out + share**2 * lean[:, None] * out + share * [0, 1, 0] * (top - 0.24)[:, None]
    paths = paths + [0, 0.24, 0]
    stem, step = rng.integers(stems, size=quads), rng.uniform(0.35, 1, quads) * 6
    before = np.minimum(step.astype(int), 5)
    part = (step - before)[:, None]
    feet = (1 - part) * paths[before, stem] + part * paths[before + 1, stem]
    angle, length = rng.uniform(0, 2 * np.pi, quads), rng.uniform(0.1, 0.22, quads)
    directions = np.stack([np.cos(angle), rng.uniform(-0.4, 0.7, quads), np.sin(angle)], axis=1)
    return joined(
        pot,
        bars(paths[:-1].reshape(-1, 3), paths[1:].reshape(-1, 3), 0.006, sections=6),
        leaves(feet, feet + length[:, None] * directions, 0.07),
    )


def vase(height: float) -> Shape:
    """A closed vase."""
    profile = [(0, 0), (0.2, 0), (0.33, 0.25), (0.36, 0.45), (0.2, 0.75), (0.17, 0.9), (0.24, 1)]
    return lathe(np.array([*profile, (0.2, 0.99), (0, 0.8)]) * height, sections=32)


def grille(width: float, height: float, apart: float = 0.06, bar: float = 0.005) -> Shape:
    """An upright grille of round bars, radius `bar`, on feet."""
    x, base = width / 2, 0.1
    xs = np.arange(-x + apart, x - apart / 2, apart)[:, None] * [1, 0, 0]
    ys = np.arange(base + apart, height - apart / 2, apart)[:, None] * [0, 1, 0]
    corners = np.array([[-x, base, 0], [x, base, 0], [x, height, 0], [-x, height, 0]])
    feet = np.array([[-x, 0, -0.18], [x, 0, -0.18]])
    return joined(
        bars(xs + [0, base, -bar], xs + [0, height, -bar], bar, sections=8),
        bars(ys + [-x, 0, bar], ys + [x, 0, bar], bar, sections=8),
        beams(corners, np.roll(corners, -1, axis=0), 0.03, 0.03),
        boxes(feet - [0.02, 0, 0], feet + [0.02, base, 0.36]),
    )


def bench(width: float) -> Shape:
    """A slatted bench, `width` along x, without a back."""
    x, z = width / 2, np.linspace(-0.22, 0.22, 7)[:, None] * [0, 0, 1]
    sides = [-x + 0.2, x - 0.2]
    legs = np.array([[side, 0, z] for side in sides for z in (-0.2, 0.2)])
    return joined(
        beams(z + [-x, 0.43, 0], z + [x, 0.43, 0], 0.045, 0.03),
        boxes(legs - [0.025, 0, 0.025], legs + [0.025, 0.38, 0.025]),
        boxes([[s - 0.025, 0.38, -0.24] for s in sides], [[s + 0.025, 0.415, 0.24] for s in sides]),
    )
