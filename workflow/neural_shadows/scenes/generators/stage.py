"""Bare ground of 6 m × 6 m below one object 1 m high."""

from dataclasses import dataclass

import numpy as np

from neural_shadows.scenes.arrangement import INSERTED, Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor
from neural_shadows.scenes.pieces.shapes import placed

OBJECT = 1.0  # metres, the largest height and width of the inserted object


@dataclass(frozen=True, eq=False)
class Around(Region):
    """Ring of positions round the vertical axis, between radii `low[0]` and `high[0]`."""

    def draw(self, rng: np.random.Generator) -> np.ndarray:
        radius, height, _ = super().draw(rng)
        angle = rng.uniform(0, 2 * np.pi)
        return np.array([radius * np.cos(angle), height, radius * np.sin(angle)])


def arrange(rng: np.random.Generator) -> Arrangement:
    """One spot in the middle; its turn is all that is drawn."""
    return Arrangement(
        "stage",
        (placed("ground", floor(6, 6)),),
        (Spot(np.zeros(3), OBJECT, rng.uniform(0, 2 * np.pi)),),
        lights=Region(np.array([-1.2, 2.2, -1.2]), np.array([1.2, 3.2, 1.2])),
        cameras=Around(np.array([1.5, 0.6, 0.0]), np.array([2.3, 1.7, 0.0])),
        targets=Region(np.array([-0.3, 0.1, -0.3]), np.array([0.3, 0.4, 0.3])),
        mover=INSERTED,
        lit=(0.05, 0.98),
    )
