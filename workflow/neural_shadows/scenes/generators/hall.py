"""Meeting hall of 10 m × 6 m, 3 m high.

A substitute for the conference room of Datta et al. (2022).
"""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor, window_wall
from neural_shadows.scenes.pieces.furniture import chair, plant, table, vase
from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    bars,
    beams,
    box,
    boxes,
    joined,
    placed,
)

TABLE = 0.75


def arrange(rng: np.random.Generator) -> Arrangement:
    """A long table with fourteen chairs, a screen and plants."""
    objects = (
        placed("floor", floor(10, 6)),
        placed("north wall", at(window_wall(10, 3, 5), (0, 0, -3))),
        placed("south wall", at(window_wall(10, 3, 5), (0, 0, 3), np.pi)),
        placed("end walls", boxes([[-5.1, 0, -3], [5, 0, -3]], [[-5, 3, 3], [5.1, 3, 3]])),
        placed("table", _long_table()),
        *(placed(f"chair {k + 1}", each) for k, each in enumerate(_chairs(rng))),
        placed("on the table", *_table_objects(rng)),
        placed("screen", at(_screen(), (-4.5, 0, rng.uniform(-0.5, 0.5)), np.pi / 2)),
        placed("plant 1", at(plant(rng, 1.5), (4.5, 0, -2.4))),
        placed("plant 2", at(plant(rng, 1.2), (-4.4, 0, 2.4))),
        placed("vase", at(vase(0.3), (rng.uniform(0.6, 1.2), TABLE, 0))),
    )
    spots = (
        Spot(np.array([0.0, TABLE, 0.0]), 0.55, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([4.3, 0.0, 1.6]), 1.0, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([-1.6, TABLE, 0.0]), 0.45, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "hall",
        objects,
        spots,
        lights=Region(np.array([-2.5, 2.1, -1.5]), np.array([2.5, 2.7, 1.5])),
        cameras=Region(np.array([-4.3, 1.2, -2.5]), np.array([4.3, 2.2, 2.5])),
        targets=Region(np.array([-2.5, 0.3, -0.9]), np.array([2.5, 0.9, 0.9])),
        mover="chair 1",
    )


def _long_table() -> Shape:
    """Three tables end to end: twelve legs."""
    return joined(*(at(table(1.9, 1.3, TABLE), (x, 0, 0)) for x in (-1.9, 0, 1.9)))


def _chairs(rng: np.random.Generator) -> list[Shape]:
    """Six chairs along each side, one at each end."""
    sides = [(x, z, turn) for z, turn in ((0.85, np.pi), (-0.85, 0.0)) for x in _ALONG]
    positions = [*sides, (-3.1, 0, np.pi / 2), (3.1, 0, -np.pi / 2)]
    chairs = []
    for x, z, turn in positions:
        back = rng.uniform(0, 0.35) * np.array([np.sin(turn), 0, np.cos(turn)])
        position = np.array([x, 0, z]) - back
        chairs.append(at(chair(6), position, turn + rng.uniform(-0.15, 0.15)))
    return chairs


_ALONG = np.array([-2.3, -1.45, -0.48, 0.48, 1.45, 2.3])


def _table_objects(rng: np.random.Generator) -> list[Shape]:
    """Open notebooks, cups and pens at some chairs."""
    lid = beams([[0, 0.01, -0.115]], [[0, 0.22, -0.19]], 0.32, 0.008)
    notebook = joined(box((-0.16, 0, -0.115), (0.16, 0.016, 0.115)), lid)
    cup = bars([[0.24, 0, -0.02]], [[0.24, 0.1, -0.02]], 0.04, 24)
    pen = bars([[0.2, 0.006, 0.08]], [[0.32, 0.006, 0.12]], 0.006, 6)
    objects = []
    for z, turn in ((0.42, 0.0), (-0.42, np.pi)):
        for x in _ALONG:
            if rng.random() < 0.6:
                items = [notebook, cup, pen][: rng.integers(1, 4)]
                objects.append(at(joined(*items), (x, TABLE, z), turn + rng.uniform(-0.2, 0.2)))
    return objects or [at(notebook, (0.5, TABLE, 0.4))]


def _screen() -> Shape:
    """A screen on a stand with thin legs, facing +z."""
    legs = np.array([[-0.5, 0, 0.25], [0.5, 0, 0.25], [0.5, 0, -0.25], [-0.5, 0, -0.25]])
    return joined(
        bars(legs + [0, 0.012, 0], legs * [1, 0, 0.1] + [0, 1.0, 0], 0.012, 12),
        boxes(legs[:2] * [1, 0, -1] - 0.02 * np.eye(3)[0], legs[:2] + [0.02, 0.02, 0]),
        box((-0.8, 1.0, -0.02), (0.8, 1.95, 0.02)),
        boxes(
            [[-0.82, 0.98, -0.03], [-0.82, 1.93, -0.03]], [[0.82, 1.01, 0.04], [0.82, 1.97, 0.04]]
        ),
    )
