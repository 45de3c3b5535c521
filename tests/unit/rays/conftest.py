"""A ray set as the stages make it, in two shards."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from rays import open_rays

from neural_shadows.rays.draw_directions import draw_directions
from neural_shadows.rays.label_rays import label_rays
from neural_shadows.rays.sample_rays import sample_rays

DIRECTIONS, POINTS, SEED = 30, 400, 3


@pytest.fixture(scope="session")
def sampling():
    """Settings of the ray set."""
    return {
        "sampler": "poisson_quadtree",
        "directions": DIRECTIONS,
        "points_per_direction": POINTS,
        "silhouette_resolution": 32,
        "min_quad": 1,
    }


@pytest.fixture(scope="session")
def shape():
    """A torus, which hides itself, with a loose sheet: rays of every kind."""
    ring = trimesh.creation.torus(0.6, 0.15, major_sections=40, minor_sections=16)
    corners = [[-0.4, 0, 0.6], [0.4, 0, 0.6], [0.4, 0.4, 0.6]]
    return ring + trimesh.Trimesh(corners, [[0, 1, 2]], process=False)


@pytest.fixture(scope="session")
def mesh_ply(shape, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("mesh") / "mesh.ply"
    path.write_bytes(shape.export(file_type="ply"))
    return path


@pytest.fixture(scope="session")
def make_set(mesh_ply, sampling):
    """A function that makes the ray set in a folder, in shards between the cuts."""

    def make(folder, cuts=(0, 11, DIRECTIONS), threads=2, **changes):
        settings, files = sampling | changes, {"mesh_ply": mesh_ply}
        files["directions_npy"] = folder / "directions.npy"
        draw_directions(directions_npy=files["directions_npy"], sampling=settings, seed=SEED)
        for shard, (first, last) in enumerate(zip(cuts, cuts[1:], strict=False)):
            files["origins_npy"] = folder / f"origins.{shard:03}.npy"
            part = {"seed": SEED, "first": first, "last": last, "threads": threads}
            sample_rays(sampling=settings, **files, **part)
            label_rays(bounds_npy=folder / f"bounds.{shard:03}.npy", **files, **part)
        return folder

    return make


@pytest.fixture(scope="session")
def ray_set(make_set, tmp_path_factory) -> Path:
    """Folder of the ray set, which tests leave as it is."""
    return make_set(tmp_path_factory.mktemp("rays"))


@pytest.fixture(scope="session")
def everything():
    """A function that gives all rays of a folder: origins, directions, t_lb, t_ub."""

    def gather(folder):
        rays = open_rays(folder)
        return rays.gather(np.arange(rays.count))

    return gather
