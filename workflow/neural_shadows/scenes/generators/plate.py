"""Ground below one object, for penumbrae (Datta et al. 2022, 3.6)."""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor
from neural_shadows.scenes.pieces.shapes import placed

LIGHT = 3.0  # metres above the ground
OBJECT = 0.4  # height of the inserted object: a radius of 0.2 m
HIGHEST = 2.1  # largest height of a spot in metres, clear of the light


def arrange_plate(height: float) -> Arrangement:
    """A ground of 4 m × 4 m, one spot above its middle.

    Args:
        height: of the spot over the ground, metres, at most `HIGHEST`.
    """
    middle = np.array([0.0, height, 0.0])
    return Arrangement(
        "plate",
        (placed("ground", floor(4, 4)),),
        (Spot(middle, OBJECT, 0.0),),
        lights=Region(np.array([-0.1, LIGHT, -0.1]), np.array([0.1, LIGHT, 0.1])),
        cameras=Region(np.array([-0.8, 1.6, 1.9]), np.array([0.8, 2.2, 2.4])),  # 3 m away
        targets=Region(np.array([-0.3, 0.0, -0.3]), np.array([0.3, 0.1, 0.3])),
        mover="ground",
        lit=(0.05, 0.995),  # one shadow of a hand's breadth, on 8 m²
    )


def arrange(rng: np.random.Generator) -> Arrangement:
    """Draw the spot's height from 0.4 m to 1.6 m."""
    return arrange_plate(rng.uniform(0.4, 1.6))
