"""Stage: check and describe a whole ray set."""

from pathlib import Path

from neural_shadows.files.whole_files import sha256_of, write_json
from neural_shadows.rays.labels import SECOND_HIT_STEP
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
        rays_json: gets the counts, settings, units and checksums.

    Raises:
        InputError: as `RaySet`.
    """
    rays = RaySet(directions_npy, origins, bounds)
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
        },
    )


if "snakemake" in globals():
    run_stage(snakemake, describe_rays)
