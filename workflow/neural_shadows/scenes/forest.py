"""Many copies of few objects over a level ground, none where another stands."""

from collections.abc import Sequence

import numpy as np
from trimesh.transformations import rotation_matrix

from neural_shadows.scenes.arrangement import UP

SIZES = (0.6, 1.0)  # an object's scale, drawn between these
APART = 2.4  # of the ground's squares, in radii of the largest: each has one object, anywhere in it
SHIFT = 0.6  # how far from its square's middle an object may stand
TILT = 6.0  # degrees, the most; an object then stands as deep as its foot's radius needs


def scattered(
    objects: Sequence[np.ndarray], ups: Sequence[str], count: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Which object each of `count` instances is of, (n,) int64, and where it stands: (n, 4, 4).

    y is up and the ground at y = 0, on which all objects stand on a square about the origin.

    Args:
        objects: vertices (V, 3) of each, in its unit sphere. ups: the axis of each that points up.
    """
    kinds = rng.permutation(np.arange(count) % len(objects))
    side = int(np.ceil(np.sqrt(count)))
    squares = np.stack(np.unravel_index(np.arange(count), (side, side)), axis=1)
    places = APART * (squares + 0.5 - side / 2) + rng.uniform(-SHIFT, SHIFT, (count, 2))
    placements = np.empty((count, 4, 4))
    for one, (kind, (x, z)) in enumerate(zip(kinds, places)):
        angle, tilt = rng.uniform(0, 2 * np.pi, 2), np.radians(TILT) * np.sqrt(rng.random())
        motion = rotation_matrix(tilt, [np.cos(angle[0]), 0, np.sin(angle[0])])
        motion = motion @ rotation_matrix(angle[1], UP) @ _upright(ups[kind])
        motion[:3, :3] *= rng.uniform(*SIZES)
        motion[:3, 3] = x, -(objects[kind] @ motion[1, :3]).min(), z
        placements[one] = motion
    return kinds, placements


def _upright(up: str) -> np.ndarray:
    """The turn (4, 4) that makes an axis y."""
    turn = np.eye(4)
    turn[:3, :3] = np.roll(np.eye(3), 1 - "xyz".index(up), axis=0)
    return turn
