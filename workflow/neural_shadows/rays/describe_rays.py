"""The stage that describes a whole ray set, for whoever trains on it."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.files.whole_files import sha256_of, write_json
from neural_shadows.rays.labels import SECOND_HIT_STEP, chord_lengths
from neural_shadows.rays.ray_set import RaySet


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
