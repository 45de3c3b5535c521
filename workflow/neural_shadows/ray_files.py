"""The stages directions, rays and labels, and the ray sets that they leave on disk [3.4].

A ray set of D directions with m points each, in S shards (consecutive ranges of directions):

- `directions.npy`: (D, 3) float32, unit vectors d.
- `origins.SSS.npy`: (D_s, m, 3) float32, points o on the unit sphere, o·d < 0.
- `bounds.SSS.npy`: (D_s, m, 2) float32, [t_lb, t_ub], distances from o; t_ub may be ∞.
- `rays.json`: counts, settings, units and statistics (see `describe_rays`).

All in normalised space: lengths are in radii of the object's minimal bounding sphere.
"""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from numba import njit

from neural_shadows.errors import InputError
from neural_shadows.files import sha256_of, whole_file, write_array, write_json
from neural_shadows.labels import SECOND_HIT_STEP, chord_lengths, dual_bounds
from neural_shadows.mesh import read_prepared
from neural_shadows.poisson_disk import PatternBank, sphere_directions
from neural_shadows.progress import progress_bar
from neural_shadows.ray_sampling import SAMPLERS, sample_rays
from neural_shadows.tracing import Tracer

# The random numbers of each use come from (seed, use, ...), so that none repeats another's.
_DIRECTIONS, _POINTS, _PATTERNS = range(3)

# Rays that one task of a thread traces at least: below that, starting the task shows.
_TASK_RAYS = 8192


def make_directions(out_npy: str | Path, *, sampler: str, directions: int, seed: int) -> None:
    """Draw the view directions of a ray set and write `directions.npy` [3.4.1].

    Args:
        sampler: `poisson_quadtree` gives a Poisson-disk pattern on the sphere, the others
            independent uniform directions.
        directions: their number D.

    Raises:
        InputError: an unknown sampler, or a number below 1.
    """
    _check_sampler(sampler)
    _check_positive("directions", directions)
    if sampler == "poisson_quadtree":
        found = sphere_directions(directions, (seed, _DIRECTIONS))[0]
    else:
        found = np.random.default_rng((seed, _DIRECTIONS)).normal(size=(directions, 3))
        found /= np.linalg.norm(found, axis=1, keepdims=True)
    write_array(out_npy, found.astype(np.float32))


def make_rays(
    mesh_ply: str | Path,
    directions_npy: str | Path,
    origins_npy: str | Path,
    *,
    sampler: str,
    points_per_direction: int,
    silhouette_resolution: int,
    min_quad: int,
    seed: int,
    first: int,
    last: int,
    threads: int,
) -> None:
    """Sample the rays of the directions first to last − 1 and write their shard [3.4.2].

    What is drawn for a direction depends on the seed and the direction's index alone, not on
    shards or threads.

    Args:
        mesh_ply: the mesh in normalised space.
        directions_npy: from `make_directions`.
        origins_npy: where the shard goes.

    Raises:
        InputError: an unknown sampler, a wrong number, or a file that cannot be used.
        ValueError: `silhouette_resolution` or `min_quad` is no power of two.
    """
    _check_sampler(sampler)
    _check_positive("points_per_direction", points_per_direction)
    directions = _read_directions(directions_npy)
    _check_range(first, last, len(directions), directions_npy)
    tracer = _tracer(mesh_ply)
    bank = PatternBank((seed, _PATTERNS))

    with whole_file(origins_npy) as part:
        origins = _new_array(part, (last - first, points_per_direction, 3))

        def sample(begin: int, end: int) -> None:
            for i in range(begin, end):
                origins[i] = sample_rays(
                    tracer,
                    directions[first + i],
                    points_per_direction,
                    sampler,
                    silhouette_resolution=silhouette_resolution,
                    min_quad=min_quad,
                    rng=np.random.default_rng((seed, _POINTS, first + i)),
                    bank=bank,
                )

        _run_tasks(sample, last - first, points_per_direction, threads, "rays")
        origins.flush()


def make_labels(
    mesh_ply: str | Path,
    directions_npy: str | Path,
    origins_npy: str | Path,
    bounds_npy: str | Path,
    *,
    first: int,
    last: int,
    threads: int,
) -> None:
    """Trace the rays of a shard and write their bounds [3.4.3].

    Args:
        mesh_ply: the mesh in normalised space.
        directions_npy, origins_npy: from `make_directions`, and from `make_rays` for the
            directions first to last − 1.
        bounds_npy: where the shard's bounds go.

    Raises:
        InputError: a file that cannot be used, or that is of another range of directions.
        RuntimeError: a ray with impossible bounds.
    """
    directions = _read_directions(directions_npy)
    _check_range(first, last, len(directions), directions_npy)
    directions = directions[first:last]
    origins = _open(origins_npy, (last - first, None, 3))
    points = origins.shape[1]
    tracer = _tracer(mesh_ply)

    with whole_file(bounds_npy) as part:
        bounds = _new_array(part, (last - first, points, 2))

        def label(begin: int, end: int) -> None:
            t_lb, t_ub = dual_bounds(
                tracer,
                origins[begin:end].reshape(-1, 3),
                np.repeat(directions[begin:end], points, axis=0),
                name=f"{origins_npy}, directions {first + begin} to {first + end - 1}",
            )
            bounds[begin:end, :, 0] = t_lb.reshape(-1, points)
            bounds[begin:end, :, 1] = t_ub.reshape(-1, points)

        _run_tasks(label, last - first, points, threads, "labels")
        bounds.flush()


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
        self.directions = _read_directions(directions_npy)
        """(D, 3) float32."""
        if not origins_npys or len(origins_npys) != len(bounds_npys):
            raise InputError(
                f"ray set of {directions_npy}: {len(origins_npys)} origins and "
                f"{len(bounds_npys)} bounds files; give one bounds file for each origins file"
            )
        self.origins, self.bounds = [], []
        points = None
        for origins_npy, bounds_npy in zip(origins_npys, bounds_npys, strict=True):
            origins = _open(origins_npy, (None, points, 3))
            bounds = _open(bounds_npy, (*origins.shape[:2], 2))
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


def describe_rays(
    rays_json: str | Path,
    *,
    mesh_ply: str | Path,
    directions_npy: str | Path,
    origins_npys: Sequence[str | Path],
    bounds_npys: Sequence[str | Path],
    sampler: str,
    silhouette_resolution: int,
    min_quad: int,
    seed: int,
) -> dict[str, Any]:
    """Check a ray set as a whole and write what it is to `rays.json`.

    Args:
        rays_json: gets the counts, the settings it was made with, the units, the mesh's
            sha256 and that of each file, the step behind the first hit, and the shares of rays
            that hit the object at no place (`misses`) and at one (`one_hit`).
        mesh_ply, sampler, silhouette_resolution, min_quad, seed: as given to `make_rays`.

    Returns:
        The content of `rays_json`.

    Raises:
        InputError: as `RaySet`.
    """
    rays = RaySet(directions_npy, origins_npys, bounds_npys)
    misses = one_hit = 0
    begin = 0
    for origins, bounds in zip(rays.origins, rays.bounds, strict=True):
        for i in range(len(origins)):
            along = np.broadcast_to(rays.directions[begin + i], origins[i].shape)
            chord = chord_lengths(origins[i], along)
            open_end = np.isinf(bounds[i, :, 1])
            missed = open_end & (bounds[i, :, 0] == chord)
            misses += int(missed.sum())
            one_hit += int(open_end.sum() - missed.sum())
        begin += len(origins)
    content = {
        "directions": len(rays.directions),
        "points_per_direction": rays.points_per_direction,
        "rays": rays.count,
        "shards": len(rays.origins),
        "sampler": sampler,
        "seed": seed,
        "silhouette_resolution": silhouette_resolution,
        "min_quad": min_quad,
        "mesh_sha256": sha256_of(mesh_ply),
        "sha256": {
            Path(file).name: sha256_of(file)
            for file in (directions_npy, *origins_npys, *bounds_npys)
        },
        "units": "radii of the minimal bounding sphere; bounds are distances from the origin",
        "second_hit_step": SECOND_HIT_STEP,
        "misses": misses / rays.count,
        "one_hit": one_hit / rays.count,
    }
    write_json(rays_json, content)
    return content


@njit(cache=True, nogil=True)
def _gather(places, directions, points, shard_origins, shard_bounds, origins, t_lb, t_ub):
    for i in range(len(places)):
        place, direction, point = places[i], directions[i], points[i]
        for axis in range(3):
            origins[place, axis] = shard_origins[direction, point, axis]
        t_lb[place] = shard_bounds[direction, point, 0]
        t_ub[place] = shard_bounds[direction, point, 1]


def _run_tasks(
    task: Callable[[int, int], None], directions: int, points: int, threads: int, title: str
) -> None:
    """Run task(begin, end) over consecutive ranges of directions in threads, with a bar.

    Embree and the numba kernels release the interpreter's lock, so that threads scale.
    """
    step = -(-_TASK_RAYS // points)
    begins = range(0, directions, step)
    ends = [min(begin + step, directions) for begin in begins]
    with (
        progress_bar(directions * points, "samples", title) as bar,
        ThreadPoolExecutor(threads) as pool,
    ):
        for begin, end, _ in zip(begins, ends, pool.map(task, begins, ends), strict=True):
            bar.update((end - begin) * points)


def _tracer(mesh_ply: str | Path) -> Tracer:
    mesh = read_prepared(mesh_ply)
    return Tracer(mesh.vertices, mesh.faces)


def _new_array(path: Path, shape: tuple[int, ...]) -> np.memmap:
    """A new float32 `.npy` file, memory-mapped for writing: it may be larger than memory."""
    array = np.lib.format.open_memmap(path, mode="w+", dtype=np.float32, shape=shape)
    if hasattr(os, "posix_fallocate"):
        # A full disk is an error here; found when a page is written, it kills the process.
        with path.open("rb+") as file:
            os.posix_fallocate(file.fileno(), 0, path.stat().st_size)
    return array


def _read_directions(path: str | Path) -> np.ndarray:
    """The directions file as an array in memory: (D, 3) float32."""
    return np.array(_open(path, (None, 3)))


def _open(path: str | Path, shape: tuple[int | None, ...]) -> np.ndarray:
    """A float32 `.npy` file, memory-mapped; `None` in `shape` is any length from 1.

    Raises:
        InputError: it is missing, no such file, or of another type or shape.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file; run the stage that makes it")
    try:
        array = np.load(path, mmap_mode="r", allow_pickle=False)
    except (ValueError, OSError, EOFError) as error:
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


def _check_sampler(sampler: str) -> None:
    if sampler not in SAMPLERS:
        raise InputError(f"sampler: {sampler!r} is unknown; use one of {', '.join(SAMPLERS)}")


def _check_positive(key: str, value: int) -> None:
    if value < 1:
        raise InputError(f"{key}: {value} is too few; give 1 or more")


def _check_range(first: int, last: int, directions: int, directions_npy: str | Path) -> None:
    if not 0 <= first < last <= directions:
        raise InputError(
            f"first, last: {first} to {last} is no range of the {directions} directions in "
            f"{directions_npy}; give 0 <= first < last <= {directions}"
        )
