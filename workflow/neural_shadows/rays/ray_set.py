"""A ray set on disk: view directions, rays and their bounds [3.4].

A ray set of D directions with m points each, in S shards (consecutive ranges of directions):

- `directions.npy`: (D, 3) float32, unit vectors d.
- `origins.SSS.npy`: (D_s, m, 3) float32, points o on the unit sphere, o·d < 0.
- `bounds.SSS.npy`: (D_s, m, 2) float32, [t_lb, t_ub], distances from o; t_ub may be ∞.
- `rays.json`: counts, settings, units and statistics (see `describe_rays`).

All in normalised space: lengths are in radii of the object's minimal bounding sphere.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numba import njit

from neural_shadows.errors import InputError
from neural_shadows.files.arrays import open_array


class RaySet:
    """A memory-mapped ray set, read on access.

    `origins` and `bounds` are the shards, in the order of their directions.

    Raises:
        InputError: a damaged file, or files of different ray sets.
    """

    def __init__(self, directions_npy: Path, origins: Sequence[Path], bounds: Sequence[Path]):
        self.directions = read_directions(directions_npy)
        self.origins, self.bounds = [], []
        for origins_npy, bounds_npy in zip(origins, bounds, strict=True):
            points = self.origins[0].shape[1] if self.origins else None
            shard = open_array(origins_npy, (None, points, 3))
            self.origins.append(shard)
            self.bounds.append(open_array(bounds_npy, (*shard.shape[:2], 2)))
        count = sum(len(shard) for shard in self.origins)
        if count != len(self.directions):
            raise InputError(
                f"{directions_npy}: has {len(self.directions)} directions, but the "
                f"origins files have {count}. Delete the files of one of them and run again."
            )
        self.points_per_direction: int = self.origins[0].shape[1]

    @property
    def count(self) -> int:
        """Number of rays, D · m."""
        return len(self.directions) * self.points_per_direction

    def gather(self, indices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Gather origins (n, 3), directions (n, 3), t_lb and t_ub (n,), float32.

        Ray i is point i mod m of direction i div m, for i in [0, count).
        """
        directions = self.directions[indices // self.points_per_direction]
        origins = np.empty((len(indices), 3), np.float32)
        bounds = np.empty((len(indices), 2), np.float32)
        for shard, labels in zip(self.origins, self.bounds):
            shard, labels = shard.reshape(-1, 3), labels.reshape(-1, 2)
            _gather(indices, shard, labels, origins, bounds)
            indices = indices - len(shard)
        return origins, directions, bounds[:, 0], bounds[:, 1]


def read_directions(path: Path) -> np.ndarray:
    """Read the directions file: (D, 3) float32."""
    return np.array(open_array(path, (None, 3)))


@njit(cache=True, nogil=True)
def _gather(indices, shard, labels, origins, bounds):
    """Gather the rays of a shard; its first has index 0."""
    for i in range(len(indices)):
        if 0 <= indices[i] < len(shard):
            for axis in range(3):  # assigning rows takes numba a second to compile
                origins[i, axis] = shard[indices[i], axis]
            for end in range(2):
                bounds[i, end] = labels[indices[i], end]
