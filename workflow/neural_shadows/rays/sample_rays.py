"""Stage: sample and label the rays of one shard of a ray set [3.4.2, 3.4.3]."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from neural_shadows.files.arrays import new_array
from neural_shadows.meshes.reading import read_mesh
from neural_shadows.rays.labels import check_bounds, dual_bounds
from neural_shadows.rays.poisson_disk import PatternBank
from neural_shadows.rays.ray_set import read_directions
from neural_shadows.rays.sampling import sample_direction
from neural_shadows.rays.streams import PATTERNS, POINTS
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.tracing import Tracer
from neural_shadows.settings.records import SamplingSettings

# Least rays of a task: with fewer, starting it takes noticeable time.
_TASK_RAYS = 8192


def sample_rays(
    *,
    mesh_ply: Path,
    directions_npy: Path,
    origins_npy: Path,
    bounds_npy: Path,
    sampling: SamplingSettings,
    seed: int,
    first: int,
    last: int,
    threads: int = 1,
) -> None:
    """Sample and trace the rays of the directions first to last − 1 and write their shard.

    The rays of a direction depend on the seed and its index alone, not on shards or threads.

    Args:
        origins_npy: gets (last − first, m, 3) float32 points on the unit sphere.
        bounds_npy: gets (last − first, m, 2) float32, [t_lb, t_ub] of each ray.
        sampling: see `sample_direction`.

    Raises:
        InputError: an unusable file.
        RuntimeError: a ray with impossible bounds, named by shard, seed and index.
    """
    directions = read_directions(directions_npy)[first:last]
    points = sampling["points_per_direction"]
    # Without normals, which no ray needs: they take 0.17 s for a dragon of 325,000 faces.
    vertices, faces = read_mesh(mesh_ply)
    tracer = Tracer(np.float32(vertices), np.int32(faces))
    name = f"labels {bounds_npy} (seed {seed})"
    bank = PatternBank((seed, PATTERNS))

    with (
        new_array(origins_npy, (len(directions), points, 3)) as origins,
        new_array(bounds_npy, (len(directions), points, 2)) as bounds,
    ):

        def sample(begin: int, end: int) -> None:
            for i in range(begin, end):
                origins[i] = sample_direction(
                    tracer,
                    directions[i],
                    sampling,
                    rng=np.random.default_rng((seed, POINTS, first + i)),
                    bank=bank,
                )

            rays = np.array(origins[begin:end]).reshape(-1, 3)
            t_lb, t_ub = dual_bounds(tracer, rays, np.repeat(directions[begin:end], points, axis=0))
            bounds[begin:end, :, 0] = t_lb.reshape(-1, points)
            bounds[begin:end, :, 1] = t_ub.reshape(-1, points)
            check_bounds(
                directions[begin:end],
                rays.reshape(-1, points, 3),
                bounds[begin:end],
                name=name,
                first=first + begin,
            )

        begins = range(0, len(directions), -(-_TASK_RAYS // points))
        ends = [*begins, len(directions)][1:]
        with (
            progress_bar(len(directions) * points, "samples", "rays") as bar,
            # Embree and the numba kernels release the interpreter's lock, so that threads scale.
            ThreadPoolExecutor(threads) as pool,
        ):
            for begin, end, _ in zip(begins, ends, pool.map(sample, begins, ends), strict=True):
                bar.update((end - begin) * points)


if "snakemake" in globals():
    run_stage(snakemake, sample_rays)
