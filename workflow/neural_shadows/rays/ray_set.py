"""A ray set on disk: view directions, rays and their bounds [3.4].

A ray set of D directions with m points each, in S shards (consecutive ranges of directions):

- `directions.npy`: (D, 3) float32, unit vectors d.
- `origins.SSS.npy`: (D_s, m, 3) float32, points o on the unit sphere, o·d < 0.
- `bounds.SSS.npy`: (D_s, m, 2) float32, [t_lb, t_ub], distances from o; t_ub may be ∞.
- `rays.json`: counts, settings, units and statistics (see `ray_files.describe_rays`).

All in normalised space: lengths are in radii of the object's minimal bounding sphere.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numba import njit

from neural_shadows.errors import InputError


class RaySet:
    """A ray set on disk, opened with memory mapping; nothing is read before it is asked for.

    Args:
        directions_npy: (D, 3) float32.
        origins_npys, bounds_npys: the shards, in the order of their directions.

    Raises:
        InputError: a file is missing, truncated or of another kind, or the files are not of
            the same ray set.
    """

    def __init__(
        self,
        directions_npy: str | Path,
        origins_npys: Sequence[str | Path],
        bounds_npys: Sequence[str | Path],
    ):
        self.directions = read_directions(directions_npy)
        """(D, 3) float32."""
        if not origins_npys or len(origins_npys) != len(bounds_npys):
            raise InputError(
                f"ray set of {directions_npy}: {len(origins_npys)} origins and "
                f"{len(bounds_npys)} bounds files; give one bounds file for each origins file"
            )
        self.origins, self.bounds = [], []
        points = None
        for origins_npy, bounds_npy in zip(origins_npys, bounds_npys, strict=True):
            origins = open_array(origins_npy, (None, points, 3))
            bounds = open_array(bounds_npy, (*origins.shape[:2], 2))
            points = origins.shape[1]
            self.origins.append(origins)
            self.bounds.append(bounds)
        found = sum(len(origins) for origins in self.origins)
        if found != len(self.directions):
            raise InputError(
                f"{directions_npy}: has {len(self.directions)} directions, but the origins "
                f"files are of {found}; delete the files of one of them and run again"
            )
        self.points_per_direction: int = points
        """m."""

    @classmethod
    def in_folder(cls, folder: str | Path) -> "RaySet":
        """The ray set with the standard file names in a folder."""
        folder = Path(folder)
        origins = sorted(folder.glob("origins.*.npy"))
        bounds = sorted(folder.glob("bounds.*.npy"))
        return cls(folder / "directions.npy", origins, bounds)

    @property
    def count(self) -> int:
        """Number of rays, D · m."""
        return len(self.directions) * self.points_per_direction

    def gather(self, indices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Some of the rays with their labels.

        Args:
            indices: (n,) int64 in [0, count), in any order; ray i is point i mod m of
                direction i div m.

        Returns:
            origins (n, 3), directions (n, 3), t_lb (n,), t_ub (n,), all float32.
        """
        directions, points = np.divmod(indices, self.points_per_direction)
        if len(indices) and not 0 <= directions.min() <= directions.max() < len(self.directions):
            raise IndexError(f"ray indices {indices.min()} to {indices.max()} of {self.count} rays")
        origins = np.empty((len(indices), 3), np.float32)
        t_lb = np.empty(len(indices), np.float32)
        t_ub = np.empty(len(indices), np.float32)
        # Shard by shard; 16 bits are enough for the shards, and sorted in linear time.
        begins = np.cumsum([0] + [len(shard) for shard in self.origins])
        shards = (np.searchsorted(begins, directions, side="right") - 1).astype(np.uint16)
        order = np.argsort(shards, kind="stable")
        cuts = np.searchsorted(shards[order], np.arange(len(self.origins) + 1))
        for i in np.flatnonzero(np.diff(cuts)):
            chosen = order[cuts[i] : cuts[i + 1]]
            local = directions[chosen] - begins[i], points[chosen]
            _gather(chosen, *local, self.origins[i], self.bounds[i], origins, t_lb, t_ub)
        return origins, self.directions[directions], t_lb, t_ub


def read_directions(path: str | Path) -> np.ndarray:
    """The directions file as an array in memory: (D, 3) float32."""
    return np.array(open_array(path, (None, 3)))


def open_array(path: str | Path, shape: tuple[int | None, ...]) -> np.ndarray:
    """A float32 `.npy` file, memory-mapped; `None` in `shape` is any length from 1.

    Raises:
        InputError: it is missing, no such file, or of another type or shape.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file; run the stage that makes it")
    try:
        # Not np.load, which opens archives too. A shape may be more than a number holds.
        with np.errstate(over="ignore"):
            array = np.lib.format.open_memmap(path, mode="r")
    except Exception as error:  # whatever a damaged header makes Python's own parser raise
        reason = " ".join(str(error).split())[:200]
        raise InputError(
            f"{path}: is truncated or no array file ({reason}); delete it and run again"
        ) from error
    wanted = tuple("any" if length is None else length for length in shape)
    if array.dtype != np.float32 or array.ndim != len(shape) or 0 in array.shape:
        fits = False
    else:
        fits = all(a == b or b is None for a, b in zip(array.shape, shape, strict=True))
    if not fits:
        raise InputError(
            f"{path}: holds {array.dtype} {array.shape} where float32 {wanted} belongs; "
            "delete it and run again"
        )
    return np.asarray(array)  # a plain view of the mapping: numba takes no memmap


@njit(cache=True, nogil=True)
def _gather(places, directions, points, shard_origins, shard_bounds, origins, t_lb, t_ub):
    for i in range(len(places)):
        place, direction, point = places[i], directions[i], points[i]
        for axis in range(3):
            origins[place, axis] = shard_origins[direction, point, axis]
        t_lb[place] = shard_bounds[direction, point, 0]
        t_ub[place] = shard_bounds[direction, point, 1]
