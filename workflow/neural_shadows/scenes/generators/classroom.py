"""Classroom of 9 m × 7 m: desks, chairs, board."""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor, window_wall
from neural_shadows.scenes.pieces.furniture import books, chair, shelf, table
from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    balls,
    bars,
    box,
    boxes,
    joined,
    lathe,
    placed,
    ring,
)

DESK = 0.72


def arrange(rng: np.random.Generator) -> Arrangement:
    """Four rows of four desks, teacher's desk, globe, shelf."""
    objects = [
        placed("floor", floor(9, 7)),
        placed("windows", at(window_wall(9, 2.8, 4), (0, 0, -3.5))),
        placed(
            "walls", boxes([[-4.6, 0, -3.5], [4.5, 0, -3.5]], [[-4.5, 2.8, 3.5], [4.6, 2.8, 3.5]])
        ),
        placed("board", at(_board(), (-4.47, 0, 0), np.pi / 2)),
        placed("teacher's desk", at(table(1.5, 0.7), (-3.1, 0, -1.4), np.pi / 2)),
        placed("globe", at(_globe(), (-3.1, 0.75, -1.8))),
        placed("shelf", at(shelf(rng, 1.8, 1.4, 4), (4.3, 0, rng.uniform(-1.5, 1.5)), -np.pi / 2)),
    ]
    for k, (x, z) in enumerate(
        (x, z) for x in (-1.2, 0.2, 1.6, 3.0) for z in (-2.4, -0.8, 0.8, 2.4)
    ):
        position = np.array([x, 0, z]) + rng.uniform(-0.06, 0.06, 3) * [1, 0, 1]
        turn = -np.pi / 2 + rng.uniform(-0.06, 0.06)
        objects.append(placed(f"desk {k + 1}", at(_desk(rng), position, turn)))
        back = position + [rng.uniform(0.4, 0.6), 0, rng.uniform(-0.1, 0.1)]
        objects.append(placed(f"chair {k + 1}", at(chair(5), back, turn + rng.uniform(-0.3, 0.3))))
    spots = (
        Spot(np.array([-3.1, 0.75, -1.1]), 0.5, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([-3.0, 0.0, 1.2]), 1.2, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "classroom",
        tuple(objects),
        spots,
        lights=Region(np.array([-2.0, 2.2, -1.8]), np.array([2.0, 3.0, 1.8])),
        cameras=Region(np.array([-4.0, 1.2, -3.0]), np.array([4.0, 2.2, 3.2])),
        targets=Region(np.array([-2.0, 0.2, -1.6]), np.array([2.0, 0.9, 1.6])),
        mover="chair 1",
    )


def _desk(rng: np.random.Generator) -> Shape:
    """A desk with a shelf, with upright, lying or no books."""
    desk = joined(table(1.1, 0.5, DESK, 0.018), box((-0.48, 0.55, -0.18), (0.48, 0.565, 0.18)))
    kind = rng.integers(3)
    if kind == 0:
        return joined(desk, at(books(rng, 0.3, 0.26), (rng.uniform(-0.3, 0.3), DESK, 0.05)))
    if kind == 1:
        high = rng.uniform(0.02, 0.05, 3).cumsum()
        pile = [box((-0.11, low, -0.08), (0.11, up, 0.08)) for low, up in zip([0, *high], high)]
        turned = [at(book, (0, 0, 0), rng.uniform(-0.4, 0.4)) for book in pile]
        return joined(desk, at(joined(*turned), (rng.uniform(-0.35, 0.35), DESK, 0)))
    return desk


def _board() -> Shape:
    """A framed board with a ledge, facing +z, 3 cm thick."""
    return joined(
        box((-1.6, 0.9, -0.03), (1.6, 2.1, 0)),
        boxes([[-1.65, 0.86, -0.03], [-1.65, 2.1, -0.03]], [[1.65, 0.9, 0.12], [1.65, 2.14, 0.02]]),
        boxes([[-1.65, 0.9, -0.03], [1.6, 0.9, -0.03]], [[-1.6, 2.1, 0.02], [1.65, 2.1, 0.02]]),
    )


def _globe() -> Shape:
    """A globe within a ring, on a foot."""
    return joined(
        lathe([(0, 0), (0.11, 0), (0.1, 0.015), (0.015, 0.04), (0.012, 0.12), (0, 0.12)]),
        balls([[0, 0.26, 0]], 0.14, 3),
        at(ring(0.17, 0.006), (0, 0.26, 0)),
        bars([[-0.172, 0.26, 0]], [[0.172, 0.26, 0]], 0.004),
    )
