"""Stage: check and describe a whole ray set."""

from itertools import chain
from pathlib import Path

import numpy as np

from neural_shadows.files.whole_files import sha256_of, write_json
from neural_shadows.rays.labels import SECOND_HIT_STEP, chord_lengths
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import SamplingSettings


def describe_rays(
    *,
    mesh_ply: Path,
    directions_npy: Path,
    origins: list[Path],
    bounds: list[Path],
    rays_json: Path,
    sampling: SamplingSettings,
    seed: int,
) -> None:
    """Check a ray set as a whole and write `rays.json`.

    Args:
        origins, bounds: the shards, in the order of their directions.
        rays_json: gets the counts, settings, units, checksums, and the shares of rays without a hit
            (`misses`) and with one (`one_hit`).

    Raises:
        InputError: as `RaySet`.
    """
    rays = RaySet(directions_npy, origins, bounds)
    misses, one_hit = _count(rays)
    write_json(
        rays_json,
        {
            "directions": len(rays.directions),
            "points_per_direction": rays.points_per_direction,
            "rays": rays.count,
            "shards": len(rays.origins),
            "sampler": sampling["sampler"],
            "seed": seed,
            "silhouette_resolution": sampling["silhouette_resolution"],
            "min_quad": sampling["min_quad"],
            "mesh_sha256": sha256_of(mesh_ply),
            "sha256": {file.name: sha256_of(file) for file in (directions_npy, *origins, *bounds)},
            "units": "radii of the minimal bounding sphere; bounds are distances from the origin",
            "second_hit_step": SECOND_HIT_STEP,
            "misses": misses / rays.count,
            "one_hit": one_hit / rays.count,
        },
    )


def _count(rays: RaySet) -> tuple[int, int]:
    """Count the rays without a hit, and with one."""
    misses = open_ends = 0
    parts = zip(rays.directions, chain(*rays.origins), chain(*rays.bounds))
    for direction, origins, bounds in parts:
        open_end = np.isinf(bounds[:, 1])
        missed = open_end & (bounds[:, 0] == chord_lengths(origins, direction))
        misses += int(missed.sum())
        open_ends += int(open_end.sum())
    return misses, open_ends - misses


if "snakemake" in globals():
    run_stage(snakemake, describe_rays)
