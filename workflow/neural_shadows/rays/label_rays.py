"""The stage that labels the rays of one shard."""

from pathlib import Path

import numpy as np

from neural_shadows.files.whole_files import whole_file
from neural_shadows.rays.labels import check_bounds, dual_bounds
from neural_shadows.rays.ray_set import open_array, read_directions
from neural_shadows.rays.shards import _check_range, _new_array, _run_tasks, _tracer


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
