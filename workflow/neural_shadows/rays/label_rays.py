"""Stage: label the rays of one shard of a ray set [3.4.3]."""

from pathlib import Path

import numpy as np

from neural_shadows.files.arrays import new_array, open_array
from neural_shadows.rays.labels import check_bounds, dual_bounds
from neural_shadows.rays.ray_set import read_directions
from neural_shadows.rays.shards import open_tracer, run_tasks
from neural_shadows.running.stage import run_stage


def label_rays(
    *,
    mesh_ply: Path,
    directions_npy: Path,
    origins_npy: Path,
    bounds_npy: Path,
    seed: int,
    first: int,
    last: int,
    threads: int = 1,
) -> None:
    """Trace the rays of the directions first to last − 1, write their bounds and check them.

    Args:
        origins_npy: from `sample_rays` for the same first and last.
        bounds_npy: gets (last − first, m, 2) float32, [t_lb, t_ub] of each ray.
        seed: of the rays, for the error's message.

    Raises:
        InputError: an unusable file, or one of another range of directions.
        RuntimeError: a ray with impossible bounds, named by shard, seed and index.
    """
    directions = read_directions(directions_npy)[first:last]
    origins = open_array(origins_npy, (len(directions), None, 3))
    points = origins.shape[1]
    tracer = open_tracer(mesh_ply)

    with new_array(bounds_npy, (len(directions), points, 2)) as bounds:

        def label(begin: int, end: int) -> None:
            t_lb, t_ub = dual_bounds(
                tracer,
                origins[begin:end].reshape(-1, 3),
                np.repeat(directions[begin:end], points, axis=0),
            )
            bounds[begin:end, :, 0] = t_lb.reshape(-1, points)
            bounds[begin:end, :, 1] = t_ub.reshape(-1, points)

        run_tasks(label, len(directions), points, threads, "labels")
        name = f"labels {bounds_npy} (seed {seed})"
        check_bounds(directions, origins, bounds, name=name, first=first)


if "snakemake" in globals():
    run_stage(snakemake, label_rays)
