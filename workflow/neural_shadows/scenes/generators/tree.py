"""Tree with sparse leaves, table and picket fence."""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor
from neural_shadows.scenes.pieces.furniture import bench, chair, table
from neural_shadows.scenes.pieces.outdoors import pickets, tree
from neural_shadows.scenes.pieces.shapes import at, placed

TABLE = 0.75


def arrange(rng: np.random.Generator) -> Arrangement:
    """The tree behind the middle, its limbs between light and ground."""
    objects = (
        placed("ground", floor(8, 8)),
        placed("tree", *tree(rng, 1.5)),
        placed("table", at(table(1.2, 0.8, TABLE), (1.1, 0, 1.0), rng.uniform(-0.4, 0.4))),
        placed("chair", at(chair(), (0.0, 0, 1.4), 1.9 + rng.uniform(-0.3, 0.3))),
        placed("bench", at(bench(1.6), (-1.5, 0, 0.3), rng.uniform(0.2, 0.7))),
        placed("pickets", at(pickets(rng, 7.2), (0, 0, -2.2))),
    )
    spots = (
        Spot(np.array([1.1, TABLE, 1.0]), 0.5, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([-0.9, 0.0, 1.6]), 0.8, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "tree",
        objects,
        spots,
        lights=Region(np.array([-1.2, 5.2, -1.2]), np.array([1.2, 6.2, 1.2])),
        cameras=Region(np.array([-3.6, 0.9, 1.4]), np.array([3.6, 1.8, 3.8])),
        targets=Region(np.array([-1.8, 0.0, -1.6]), np.array([1.8, 1.0, 1.2])),
        mover="chair",
    )
