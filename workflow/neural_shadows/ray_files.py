"""The stages rays and labels, and the description of the ray set that they leave [3.4]."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files import sha256_of, whole_file, write_json
from neural_shadows.labels import SECOND_HIT_STEP, check_bounds, chord_lengths, dual_bounds
from neural_shadows.mesh import read_prepared
from neural_shadows.poisson_disk import PatternBank
from neural_shadows.progress import progress_bar
from neural_shadows.ray_sampling import check_positive, check_sampler, sample_rays
from neural_shadows.ray_set import RaySet, open_array, read_directions
from neural_shadows.tracing import Tracer

# The random numbers of each use come from (seed, use, ...), so that none repeats another's;
# 0 is the view directions'.
_POINTS, _PATTERNS = 1, 2

# Rays that one task of a thread traces at least: below that, starting the task shows.
_TASK_RAYS = 8192


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
    check_sampler(sampler)
    check_positive("points_per_direction", points_per_direction)
    directions = read_directions(directions_npy)
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
    seed: int,
    first: int,
    last: int,
    threads: int,
) -> None:
    """Trace the rays of a shard, write their bounds and check them as they are written [3.4.3].

    Args:
        mesh_ply: the mesh in normalised space.
        directions_npy, origins_npy: from `make_directions`, and from `make_rays` for the
            directions first to last − 1.
        bounds_npy: where the shard's bounds go.
        seed: what the rays were drawn with, for whoever must find a ray again.

    Raises:
        InputError: a file that cannot be used, or that is of another range of directions.
        RuntimeError: a ray with impossible bounds, named by shard, seed and index; the shard
            is not left behind then.
    """
    directions = read_directions(directions_npy)
    _check_range(first, last, len(directions), directions_npy)
    directions = directions[first:last]
    origins = open_array(origins_npy, (last - first, None, 3))
    points = origins.shape[1]
    tracer = _tracer(mesh_ply)
    name = f"labels {bounds_npy} (seed {seed})"

    with whole_file(bounds_npy) as part:
        bounds = _new_array(part, (last - first, points, 2))

        def label(begin: int, end: int) -> None:
            t_lb, t_ub = dual_bounds(
                tracer,
                origins[begin:end].reshape(-1, 3),
                np.repeat(directions[begin:end], points, axis=0),
            )
            bounds[begin:end, :, 0] = t_lb.reshape(-1, points)
            bounds[begin:end, :, 1] = t_ub.reshape(-1, points)

        _run_tasks(label, last - first, points, threads, "labels")
        bounds.flush()
        check_bounds(directions, origins, open_array(part, bounds.shape), name=name, first=first)


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


def _check_range(first: int, last: int, directions: int, directions_npy: str | Path) -> None:
    if not 0 <= first < last <= directions:
        raise InputError(
            f"first, last: {first} to {last} is no range of the {directions} directions in "
            f"{directions_npy}; give 0 <= first < last <= {directions}"
        )
