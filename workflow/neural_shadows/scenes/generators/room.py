"""Furnished room of 6 m × 5 m with low walls, no ceiling.

It stands for their living room and bar: much before and behind each other, thin parts.
"""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor, walls
from neural_shadows.scenes.pieces.furniture import chair, grille, plant, shelf, table, vase
from neural_shadows.scenes.pieces.shapes import Shape, at, bars, joined, lathe, placed, ring

TABLE = 0.75
LAMP = 2.0  # height of the lamp's ring


def arrange(rng: np.random.Generator) -> Arrangement:
    """Table with six chairs, shelf, arc lamp, grille and plant."""
    middle = np.array([*rng.uniform(-0.25, 0.25, 2), 0.0])[[0, 2, 1]]
    beside = middle + [rng.choice([-0.6, 0.6]), TABLE, rng.uniform(-0.2, 0.2)]
    objects = (
        placed("floor", floor(6, 5)),
        placed("walls", walls(6, 5, 1.2)),
        placed("table", at(table(1.7, 0.95, TABLE), middle)),
        *(placed(f"chair {k + 1}", each) for k, each in enumerate(_chairs(rng, middle))),
        placed("shelf", at(shelf(rng, 1.6, 1.8), (rng.uniform(-1.8, 0.6), 0, -2.33))),
        placed("lamp", _lamp(middle)),
        placed("grille", at(grille(1.3, 1.5), (2.3, 0, rng.uniform(-0.6, 0.2)), np.pi / 2)),
        placed("plant", at(plant(rng, 1.3), (2.3 + rng.uniform(-0.1, 0.1), 0, -1.9))),
        placed("vase", at(vase(0.26), beside)),
    )
    spots = (
        Spot(middle + [0, TABLE, 0], 0.5, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([2.2, 0.0, 1.7]), 0.9, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([-2.3, 0.0, 1.8]), 0.6, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "room",
        objects,
        spots,
        lights=Region(np.array([-0.7, 3.0, -0.7]), np.array([0.7, 4.0, 0.7])),
        cameras=Region(np.array([-2.8, 1.1, -2.1]), np.array([2.8, 2.3, 2.3])),
        targets=Region(np.array([-1.2, 0.2, -1.0]), np.array([1.2, 0.8, 1.0])),
        mover="chair 1",
    )


def _chairs(rng: np.random.Generator, middle: np.ndarray) -> list[Shape]:
    """Two chairs along each long side, one at each end."""
    positions = [(-0.38, 0.58, np.pi), (0.38, 0.58, np.pi), (-0.38, -0.58, 0), (0.38, -0.58, 0)]
    positions += [(-0.98, 0, np.pi / 2), (0.98, 0, -np.pi / 2)]
    chairs = []
    for x, z, turn in positions:
        back = rng.uniform(0, 0.3) * np.array([np.sin(turn), 0, np.cos(turn)])
        chairs.append(at(chair(), middle + [x, 0, z] - back, turn + rng.uniform(-0.12, 0.12)))
    return chairs


def _lamp(middle: np.ndarray) -> Shape:
    """A lamp of two rings, hanging from a stand's arm."""
    foot = np.array([-2.6, 0.0, middle[2] - 0.9])
    over, bend = middle + [0.0, LAMP + 0.35, 0.0], foot + [0, LAMP + 0.35, 0]
    angle = 2 * np.pi * np.arange(16) / 16
    spokes = np.stack([np.cos(angle), np.zeros(16), np.sin(angle)], axis=1)
    hub = middle + [0, LAMP, 0]
    return joined(
        at(lathe([(0, 0), (0.2, 0), (0.2, 0.03), (0.03, 0.05), (0, 0.05)], 32), foot),
        bars([foot, bend, over], [bend, over, hub - [0, 0.03, 0]], [0.018, 0.015, 0.006], 12),
        at(ring(0.35, 0.012), hub),
        at(ring(0.2, 0.008), hub),
        bars(hub + 0 * spokes, hub + 0.35 * spokes, 0.006),
    )
