"""Furniture of random sizes in metres, standing on y = 0."""

import numpy as np

from neural_shadows.scenes.pieces.building import balustrade, flight
from neural_shadows.scenes.pieces.plan import Drawn
from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    bars,
    beams,
    box,
    boxes,
    joined,
    lathe,
    ring,
    smooth,
)

RISE, GOING = 0.17, 0.28  # of a podium's steps


def round_table(radius: float, height: float = 0.74) -> Shape:
    """A round top on a turned foot."""
    profile = [(0, 0), (0.28, 0), (0.26, 0.03), (0.05, 0.08), (0.04, 0.35), (0.06, 0.5)]
    profile += [(0.05, height - 0.03), (0, height - 0.03)]
    top = [(0, height - 0.03), (radius, height - 0.03), (radius, height), (0, height)]
    return joined(lathe(profile, 24), lathe(top, 48))


def stool(height: float = 0.62) -> Shape:
    """A round seat on four splayed legs with a ring."""
    angle = np.pi / 4 + np.pi / 2 * np.arange(4)
    out = np.stack([np.cos(angle), np.zeros(4), np.sin(angle)], axis=1)
    seat = [(0, height - 0.03), (0.17, height - 0.03), (0.17, height), (0, height)]
    legs = bars(0.2 * out + [0, 0.013, 0], 0.11 * out + [0, height - 0.03, 0], 0.013, 10)
    return joined(lathe(seat, 28), legs, at(ring(0.17, 0.008), (0, 0.22, 0)))


def crates(rng: np.random.Generator) -> Drawn:
    """A stack of two to five slatted crates, 0.55 wide, slightly rotated."""
    parts = []
    x, z, high = 0.27, 0.19, 0.26
    corners = np.array([[a, 0, b] for a in (-x, x) for b in (-z, z)])
    for level in range(rng.integers(2, 6)):
        ys = np.array([0.03, 0.11, 0.19])[:, None] * [0, 1, 0]
        long = [ys + [-x - 0.015, 0.03, side] for side in (-z - 0.02, z + 0.02)]
        short = [ys + [side, 0.03, -z - 0.015] for side in (-x - 0.02, x + 0.02)]
        floor = np.linspace(-z, z, 5)[:, None] * [0, 0, 1] + [-x, 0.012, 0]
        crate = joined(
            beams(corners, corners + [0, high - 0.01, 0], 0.03, 0.03),
            *(beams(row, row + [2 * x + 0.03, 0, 0], 0.012, 0.055) for row in long),
            *(beams(row, row + [0, 0, 2 * z + 0.03], 0.012, 0.055) for row in short),
            beams(floor, floor + [2 * x, 0, 0], 0.05, 0.012),
        )
        parts.append(at(crate, (0, level * high, 0), rng.uniform(-0.12, 0.12)))
    return joined(*parts), 0.75, 0.6


def cloth_rail(rng: np.random.Generator, width: float, height: float = 1.6) -> Shape:
    """A rail on two stands with hanging cloths, `width` along x."""
    x = width / 2
    feet = np.array([[-x, 0.02, 0], [x, 0.02, 0]])
    parts = [
        bars(feet, feet + [0, height - 0.02, 0], 0.016, 12),
        bars(feet - [0, 0, 0.25], feet + [0, 0, 0.25], 0.018, 10),
        bars([[-x, height, 0]], [[x, height, 0]], 0.014, 12),
    ]
    u, v = np.meshgrid(np.linspace(-1, 1, 15), np.linspace(0, 1, 13), indexing="ij")
    for position in np.linspace(-x + 0.15, x - 0.15, max(2, round(width / 0.28))):
        long, phase = rng.uniform(0.6, 1.05), rng.uniform(0, 6)
        bend = 0.05 * np.sin(4 * u + phase + 2 * v) * np.minimum(1, 4 * v)
        z = (0.1 + 0.12 * np.sqrt(v)) * u
        cloth = np.stack([position + bend, height + 0.014 - long * v - 0.06 * u**2, z], axis=-1)
        parts.append(smooth(cloth))
    return joined(*parts)


def floor_lamp(height: float) -> Shape:
    """A floor lamp with a cage as its shade."""
    foot = [(0, 0), (0.16, 0), (0.16, 0.025), (0.02, 0.05), (0.015, height - 0.3)]
    angle = 2 * np.pi * np.arange(20) / 20
    out = np.stack([np.cos(angle), np.zeros(20), np.sin(angle)], axis=1)
    low, high = 0.2 * out + [0, height - 0.32, 0], 0.13 * out + [0, height, 0]
    return joined(
        lathe([*foot, (0, height - 0.3)], 20),
        bars(low, high, 0.005, 6),
        at(ring(0.2, 0.008), (0, height - 0.32, 0)),
        at(ring(0.13, 0.008), (0, height, 0)),
        bars([[-0.2, height - 0.32, 0]], [[0.2, height - 0.32, 0]], 0.006, 6),
    )


def rack(rng: np.random.Generator, width: float, height: float) -> Shape:
    """Wire shelves with tins, `width` along x, 0.44 deep."""
    x, z = width / 2, 0.22
    posts = np.array([[a, 0, b] for a in (-x, x) for b in (-z, z)])
    parts = [bars(posts, posts + [0, height, 0], 0.014, 12)]
    across = np.linspace(-x, x, round(width / 0.06))[:, None] * [1, 0, 0]
    edges = np.array([[-x, 0, -z], [x, 0, -z], [x, 0, z], [-x, 0, z]])
    for y in np.linspace(0.18, height - 0.1, 4):
        level = np.array([0, y, 0])
        parts.append(bars(across + level - [0, 0, z], across + level + [0, 0, z], 0.004, 6))
        parts.append(bars(edges + level, np.roll(edges, -1, axis=0) + level, 0.008, 8))
        at_x = np.arange(-x + 0.15, x - 0.1, 0.26)
        at_x = at_x[rng.random(len(at_x)) < 0.55]
        if len(at_x):
            feet = np.stack(
                [at_x, np.full(len(at_x), y + 0.004), rng.uniform(-0.08, 0.08, len(at_x))], axis=1
            )
            high = rng.uniform(0.1, 0.28, (len(at_x), 1)) * [0, 1, 0]
            parts.append(bars(feet, feet + high, rng.uniform(0.05, 0.1, len(at_x)), 20))
    return joined(*parts)


def podium(steps: int, width: float, length: float) -> Shape:
    """Steps along +x to a platform with balusters."""
    run, high = steps * GOING, steps * RISE
    start = -(run + length) / 2
    corner = np.array([start + run, high, -width / 2 + 0.06])
    end = corner + [length - 0.06, 0, 0]
    return joined(
        at(flight(steps, width, RISE, GOING), (start, 0, 0)),
        box((start + run, 0, -width / 2), (start + run + length, high, width / 2)),
        balustrade(corner, end),
        balustrade(end, end + [0, 0, width - 0.12]),
    )


def easel(height: float, width: float) -> Shape:
    """An easel: a leaning board on three legs, facing +z."""
    lean = 0.22 * height
    feet = np.array([[-0.32, 0.015, 0.22], [0.32, 0.015, 0.22], [0, 0.015, 0.22 - 2 * lean]])
    top = np.array(
        [[-0.06, height, 0.22 - lean], [0.06, height, 0.22 - lean], [0, height, 0.2 - lean]]
    )
    board = box((-width / 2, 0, -0.012), (width / 2, 0.6 * height, 0.012))
    tilt = np.eye(4)
    c, s = np.cos(np.arctan(0.22)), np.sin(np.arctan(0.22))
    tilt[1:3, 1:3] = [[c, s], [-s, c]]
    board.apply_transform(tilt)
    return joined(
        beams(feet, top, 0.03, 0.03),
        at(board, (0, 0.36 * height, 0.26 - 0.36 * lean)),
        boxes(
            [[-0.36, 0.33 * height, 0.22 - 0.36 * lean]],
            [[0.36, 0.35 * height, 0.32 - 0.36 * lean]],
        ),
    )
