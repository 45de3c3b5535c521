"""Gallery of 12 m × 8 m: plinths, and walls with reliefs."""

import numpy as np
import trimesh

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor, walls
from neural_shadows.scenes.pieces.furniture import bench, vase
from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    balls,
    bars,
    beams,
    box,
    boxes,
    joined,
    lathe,
    placed,
    ring,
)

PLINTH = 0.9


def arrange(rng: np.random.Generator) -> Arrangement:
    """Eight plinths, five with pieces; reliefs, a rope, a bench."""
    grid = [(x, z) for z in (-1.7, 1.7) for x in (-4.2, -1.4, 1.4, 4.2)]
    positions = np.array([[x, 0, z] for x, z in grid]) + rng.uniform(-0.25, 0.25, (8, 3)) * [
        1,
        0,
        1,
    ]
    order = rng.permutation(8)
    pieces = [vase(0.7), _rings(), _stack(rng), _cage(), _stack(rng)]
    reliefs = [
        placed(f"relief {k + 1}", at(_relief(rng, 3.2, 1.8), (x, 0.5, z), turn))
        for k, (x, z, turn) in enumerate(
            [(-3, -4, 0), (3, -4, 0), (-3, 4, np.pi), (3, 4, np.pi), (-6, 0, np.pi / 2)]
        )
    ]
    objects = (
        placed("floor", floor(12, 8)),
        placed("walls", walls(12, 8, 2.8)),
        *reliefs,
        *(
            placed(f"plinth {k + 1}", at(_plinth(), position))
            for k, position in enumerate(positions)
        ),
        *(
            placed(f"piece {k + 1}", at(piece, positions[own] + [0, PLINTH, 0], rng.uniform(0, 6)))
            for k, (piece, own) in enumerate(zip(pieces, order))
        ),
        placed("rope", at(_rope(), (4.9, 0, 0), np.pi / 2)),
        placed("bench", bench(1.8)),
    )
    spots = [Spot(positions[k] + [0, PLINTH, 0], 0.6, rng.uniform(0, 2 * np.pi)) for k in order[5:]]
    return Arrangement(
        "gallery",
        objects,
        tuple(spots),
        lights=Region(np.array([-3.5, 2.1, -3.0]), np.array([3.5, 3.0, 3.0])),
        cameras=Region(np.array([-5.2, 1.2, -3.3]), np.array([5.2, 2.1, 3.3])),
        targets=Region(np.array([-3.0, 0.2, -3.8]), np.array([3.0, 1.3, 3.8])),
        mover="piece 1",
    )


def _plinth() -> Shape:
    """A plinth with a foot and a cap."""
    return joined(
        box((-0.27, 0, -0.27), (0.27, 0.08, 0.27)),
        box((-0.23, 0.08, -0.23), (0.23, PLINTH - 0.04, 0.23)),
        box((-0.27, PLINTH - 0.04, -0.27), (0.27, PLINTH, 0.27)),
    )


def _relief(rng: np.random.Generator, width: float, height: float) -> Shape:
    """A relief facing +z: tiles and rosettes, 0.5 to 4 cm high."""
    columns, rows = 16, 9
    a, b = width / columns, height / rows
    x, y = np.meshgrid(np.arange(columns) * a - width / 2, np.arange(rows) * b, indexing="ij")
    lows = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    proud = rng.uniform(0.005, 0.04, len(lows))
    gap = rng.uniform(0.004, 0.03, (len(lows), 1)) * [1, 1, 0]
    highs = lows + np.stack([np.full(len(lows), a), np.full(len(lows), b), proud], axis=1)
    rosette = lathe([(0, 0), (0.11, 0), (0.1, 0.02), (0.07, 0.01), (0.04, 0.035), (0, 0.035)])
    facing = trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0])
    rosette.apply_transform(facing)
    own = rng.choice(len(lows), 10, replace=False)
    middles = (lows[own] + highs[own]) / 2 * [1, 1, 0] + proud[own, None] * [0, 0, 1]
    edge = np.array([[-1, 0], [1, 0], [1, 1], [-1, 1]]) * [width / 2, height]
    corners = np.pad(edge, ((0, 0), (0, 1)))
    return joined(
        boxes(lows + gap, highs - gap),
        beams(corners, np.roll(corners, -1, axis=0), 0.05, 0.05),
        *(at(rosette, middle) for middle in middles),
    )


def _rings() -> Shape:
    """Three nested upright rings on a stem, rotated."""
    stem = bars([[0, 0, 0]], [[0, 0.22, 0]], 0.03, 16)
    upright = trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0])
    rings = [ring(0.2 - 0.035 * k, 0.015).apply_transform(upright) for k in range(3)]
    return joined(stem, *(at(own, (0, 0.4, 0), k * np.pi / 3) for k, own in enumerate(rings)))


def _stack(rng: np.random.Generator) -> Shape:
    """A stack of balls of decreasing size."""
    radii = rng.uniform(0.7, 1, 3) * [0.17, 0.13, 0.09]
    heights = np.cumsum(np.r_[radii[0], (radii[:-1] + radii[1:]) * 0.95])
    middles = heights[:, None] * [0, 1, 0] + rng.uniform(-0.02, 0.02, (3, 3)) * [1, 0, 1]
    return balls(middles, radii, 3)


def _cage() -> Shape:
    """A cage of thin bars about a ball."""
    angle = 2 * np.pi * np.arange(20) / 20
    feet = np.stack([0.19 * np.cos(angle), np.zeros(20), 0.19 * np.sin(angle)], axis=1)
    rings = [ring(0.19, 0.01, height) for height in (0.01, 0.25, 0.5)]
    return joined(bars(feet, feet + [0, 0.5, 0], 0.005), *rings, balls([[0, 0.1, 0]], 0.1, 3))


def _rope() -> Shape:
    """Four posts along x with a sagging rope."""
    post = lathe([(0, 0), (0.14, 0), (0.14, 0.02), (0.02, 0.04), (0.02, 0.9), (0.04, 0.95), (0, 1)])
    x = np.linspace(-1.8, 1.8, 4)
    t = np.linspace(x[0], x[-1], 49)
    sag = 0.88 - 0.25 * (1 - (((t - x[0]) / 1.2 % 1) * 2 - 1) ** 2)
    line = np.stack([t, sag, np.zeros_like(t)], axis=1)
    return joined(*(at(post, (p, 0, 0)) for p in x), bars(line[:-1], line[1:], 0.014))
