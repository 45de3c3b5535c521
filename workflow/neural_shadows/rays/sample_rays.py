"""Stage: sample the rays of one shard of a ray set [3.4.2]."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.files.arrays import new_array
from neural_shadows.rays.poisson_disk import PatternBank
from neural_shadows.rays.ray_set import read_directions
from neural_shadows.rays.sampling import sample_direction
from neural_shadows.rays.shards import open_tracer, run_tasks
from neural_shadows.rays.streams import PATTERNS, POINTS
from neural_shadows.running.stage import run_stage


def sample_rays(
    *,
    mesh_ply: Path,
    directions_npy: Path,
    origins_npy: Path,
    sampling: Mapping[str, Any],
    seed: int,
    first: int,
    last: int,
    threads: int = 1,
) -> None:
    """Sample the rays of the directions first to last − 1 and write their shard.

    The rays of a direction depend on the seed and its index alone, not on shards or threads.

    Args:
        origins_npy: gets (last − first, m, 3) float32 points on the unit sphere.
        sampling: see `sample_direction`.

    Raises:
        InputError: an unusable file.
    """
    directions = read_directions(directions_npy)
    points = sampling["points_per_direction"]
    tracer = open_tracer(mesh_ply)
    bank = PatternBank((seed, PATTERNS))

    with new_array(origins_npy, (last - first, points, 3)) as origins:

        def sample(begin: int, end: int) -> None:
            for i in range(begin, end):
                origins[i] = sample_direction(
                    tracer,
                    directions[first + i],
                    sampling,
                    rng=np.random.default_rng((seed, POINTS, first + i)),
                    bank=bank,
                )

        run_tasks(sample, last - first, points, threads, "rays")


if "snakemake" in globals():
    run_stage(snakemake, sample_rays)
