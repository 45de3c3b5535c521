"""Room of 6 m × 5 m, lit through slats of windows."""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor, window_wall
from neural_shadows.scenes.pieces.furniture import chair, plant, shelf, table, vase
from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    bars,
    beams,
    boxes,
    joined,
    placed,
    prisms,
)

TABLE = 0.75
SILL, TOP, OPENING = 0.5, 2.4, 1.7


def arrange(rng: np.random.Generator) -> Arrangement:
    """Three windows at −z with blinds of different angles."""
    window = window_wall(6, 2.8, 3, sill=SILL, top=TOP, opening=OPENING)
    blinds = [at(_blind(rng.uniform(0.1, 0.7)), (x, 0, -2.4)) for x in (-2, 0, 2)]
    middle = np.array([rng.uniform(-0.5, 0.5), 0, rng.uniform(-0.3, 0.2)])
    objects = (
        placed("floor", floor(6, 5)),
        placed("window wall", at(window, (0, 0, -2.5))),
        placed("walls", boxes([[-3.1, 0, -2.5], [-3, 0, 2.5]], [[-3, 2.8, 2.6], [3, 2.8, 2.6]])),
        placed("far wall", boxes([[3, 0, -2.5]], [[3.1, 2.8, 2.6]])),
        placed("ceiling", boxes([[-3.1, 2.8, -2.6]], [[3.1, 2.9, 2.6]])),
        placed("blinds", *blinds),
        placed("table", at(table(1.3, 0.8, TABLE), middle)),
        placed("chair 1", at(chair(), middle + [0.25, 0, 0.75], np.pi + rng.uniform(-0.4, 0.4))),
        placed("chair 2", at(chair(), middle + [-1.0, 0, 0.1], np.pi / 2 + rng.uniform(-0.3, 0.3))),
        placed("vase", at(vase(0.3), middle + [0.4, TABLE, 0.1])),
        placed("plant", at(plant(rng, 1.3), (2.2, 0, -1.5))),
        placed("shelf", at(shelf(rng, 1.5, 1.5, 4), (rng.uniform(-1.5, 1), 0, 2.33), np.pi)),
    )
    spots = (
        Spot(middle + [-0.2, TABLE, 0.0], 0.5, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([-2.2, 0.0, -1.2]), 1.0, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "blinds",
        objects,
        spots,
        lights=Region(np.array([-1.5, 2.8, -7.0]), np.array([1.5, 4.2, -5.2])),
        cameras=Region(np.array([-2.5, 1.1, -0.9]), np.array([2.5, 2.1, 1.9])),
        targets=Region(np.array([-1.5, 0.0, -1.5]), np.array([1.5, 0.8, 1.5])),
        mover="chair 1",
    )


def _blind(tilt: float) -> Shape:
    """Bent slats of 12 cm, open by `tilt` radians, on cords."""
    x, ys = OPENING / 2 + 0.04, np.arange(SILL + 0.14, TOP - 0.04, 0.115)
    share = np.linspace(-1, 1, 11)
    across = np.stack([0.06 * share, 0.01 * (1 - share**2)], axis=1)
    turn = np.array([[np.cos(tilt), np.sin(tilt)], [-np.sin(tilt), np.cos(tilt)]])
    low, high = across @ turn, (across + [0, 0.003]) @ turn
    bend = np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
    outlines = (bend + np.stack([0 * ys, ys], axis=1)[:, None, None]).reshape(-1, 4, 2)
    slats = at(prisms(outlines, 2 * x), (0, 0, 0), np.pi / 2)
    cords = np.array([[c, SILL + 0.07, 0] for c in (-0.6, 0.0, 0.6)])
    rails = np.array([[-x, SILL + 0.06, 0], [-x, TOP + 0.03, 0]])
    return joined(
        slats,
        bars(cords, cords * [1, 0, 0] + [0, TOP + 0.03, 0], 0.0015, 6),
        beams(rails, rails * [-1, 1, 1], 0.05, 0.03),
        boxes(
            [[c, TOP + 0.02, -0.1] for c in (-0.7, 0.66)],
            [[c + 0.04, TOP + 0.05, 0] for c in (-0.7, 0.66)],
        ),
    )
