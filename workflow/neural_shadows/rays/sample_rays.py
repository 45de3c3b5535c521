"""The stage that samples the rays of one shard."""

from pathlib import Path

import numpy as np

from neural_shadows.files.whole_files import whole_file
from neural_shadows.rays.poisson_disk import PatternBank
from neural_shadows.rays.ray_set import read_directions
from neural_shadows.rays.sampling import check_positive, check_sampler, sample_rays
from neural_shadows.rays.shards import _check_range, _new_array, _run_tasks, _tracer

# The random numbers of each use come from (seed, use, ...), so that none repeats another's;
# 0 is the view directions'.
_POINTS, _PATTERNS = 1, 2


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
