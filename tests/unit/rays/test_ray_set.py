"""A ray set as the stages make it, in two shards."""

import json
import shutil

import numpy as np
import pytest
import trimesh
from rays import open_rays
from shapes import prepared

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import sha256_of
from neural_shadows.rays import sample_rays as stage
from neural_shadows.rays.describe_rays import describe_rays
from neural_shadows.rays.draw_directions import draw_directions
from neural_shadows.rays.labels import dual_bounds

SEED = 3
SAMPLING = {
    "sampler": "poisson_quadtree",
    "directions": 30,
    "points_per_direction": 400,
    "silhouette_resolution": 32,
    "min_quad": 1,
}


@pytest.fixture(scope="module")
def shape():
    """A torus, which hides itself, with a loose sheet: rays of every kind."""
    ring = trimesh.creation.torus(0.6, 0.15, major_sections=40, minor_sections=16)
    corners = [[-0.4, 0, 0.6], [0.4, 0, 0.6], [0.4, 0.4, 0.6]]
    return ring + trimesh.Trimesh(corners, [[0, 1, 2]], process=False)


@pytest.fixture(scope="module")
def mesh_ply(shape, tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / "mesh.ply"
    shape.export(path)
    return path


@pytest.fixture(scope="module")
def make_set(mesh_ply, tmp_path_factory):
    """A function that makes the ray set in a new folder, in shards between the cuts."""

    def make(cuts=(0, 11, 30), threads=2, seed=SEED, **changes):
        folder = tmp_path_factory.mktemp("rays")
        sampling, files = SAMPLING | changes, {"mesh_ply": mesh_ply}
        files["directions_npy"] = folder / "directions.npy"
        draw_directions(directions_npy=files["directions_npy"], sampling=sampling, seed=SEED)
        for shard, (first, last) in enumerate(zip(cuts, cuts[1:], strict=False)):
            for part in ("origins", "bounds"):
                files[f"{part}_npy"] = folder / f"{part}.{shard:03}.npy"
            of_shard = {"seed": seed, "first": first, "last": last, "threads": threads}
            stage.sample_rays(sampling=sampling, **files, **of_shard)
        return folder

    return make


@pytest.fixture(scope="module")
def ray_set(make_set):
    """Folder of the ray set, which tests leave as it is."""
    return make_set()


def everything(folder):
    """All rays of a folder: origins, directions, t_lb, t_ub."""
    rays = open_rays(folder)
    return rays.gather(np.arange(rays.count))


def test_rays_of_a_set_are_as_the_contract_says(ray_set, shape):
    rays = open_rays(ray_set)
    assert (rays.count, rays.points_per_direction) == (30 * 400, 400)
    assert [len(origins) for origins in rays.origins] == [11, 19]
    origins, directions, t_lb, t_ub = whole = everything(ray_set)
    assert all(array.dtype == np.float32 for array in whole)
    assert np.array_equal(directions, np.repeat(rays.directions, 400, axis=0))
    for vectors in (origins, directions):
        assert np.abs(np.linalg.norm(vectors.astype(float), axis=1) - 1).max() < 1e-6
    assert (np.sum(origins.astype(float) * directions, axis=1) < 0).all()
    assert np.array_equal([t_lb, t_ub], dual_bounds(prepared(shape)[1], origins, directions))
    for part, stored in ((origins, rays.origins), (np.stack([t_lb, t_ub], 1), rays.bounds)):
        assert np.array_equal(part, np.concatenate(stored).reshape(part.shape))
    # Any rays of both shards.
    for indices in (np.array([4400, 4399, 11_999, 0]), np.arange(0)):
        for found, stored in zip(rays.gather(indices), whole, strict=True):
            assert np.array_equal(found, stored[indices])


@pytest.mark.parametrize("sampler", ["poisson_quadtree", "uniform_quadtree", "uniform"])
def test_threads_and_shards_change_no_byte_and_seeds_do(make_set, sampler):
    contents = [
        [array.tobytes() for array in everything(make_set(cuts, threads, seed, sampler=sampler))]
        for cuts, threads, seed in [((0, 30), 1, 3), ((0, 7, 8, 30), 2, 3), ((0, 30), 1, 4)]
    ]
    assert contents[0] == contents[1]
    assert contents[0][0] != contents[2][0]


def test_the_description_names_what_a_set_is_made_of(mesh_ply, ray_set, tmp_path):
    describe_rays(
        mesh_ply=mesh_ply,
        directions_npy=ray_set / "directions.npy",
        origins=[ray_set / f"origins.00{i}.npy" for i in (0, 1)],
        bounds=[ray_set / f"bounds.00{i}.npy" for i in (0, 1)],
        rays_json=tmp_path / "rays.json",
        sampling=SAMPLING,
        seed=SEED,
    )
    content = json.loads((tmp_path / "rays.json").read_text())
    assert content["mesh_sha256"] == sha256_of(mesh_ply)
    assert len(content["sha256"]) == 5
    for file, digest in content["sha256"].items():
        assert digest == sha256_of(ray_set / file)
    expected = SAMPLING | {"rays": 12_000, "shards": 2, "seed": SEED, "second_hit_step": 2e-5}
    assert content.items() >= expected.items()


def test_a_shard_that_cannot_be_labelled_is_not_there(mesh_ply, ray_set, tmp_path, monkeypatch):
    """Rays that start inside the unit sphere."""
    sample = stage.sample_direction
    monkeypatch.setattr(stage, "sample_direction", lambda *of, **more: 0.5 * sample(*of, **more))
    files = {f"{part}_npy": tmp_path / f"{part}.npy" for part in ("origins", "bounds")}
    with pytest.raises(RuntimeError, match=r"bounds.npy \(seed 3\): ray \d+ of direction \d+ from"):
        stage.sample_rays(
            mesh_ply=mesh_ply,
            directions_npy=ray_set / "directions.npy",
            sampling=SAMPLING,
            seed=SEED,
            first=11,
            last=30,
            **files,
        )
    assert [*tmp_path.iterdir()] == []


def cut(path):
    path.write_bytes(path.read_bytes()[:-100])


def pickled(path):
    np.save(path, np.array([{}], dtype=object), allow_pickle=True)


def one_less(path):
    np.save(path, np.load(path)[:-1])


@pytest.mark.parametrize(
    ("name", "damage"),
    [("directions", cut), ("origins.001", pickled), ("directions", one_less), ("bounds.000", cut)],
)
def test_damaged_files_are_named(ray_set, tmp_path, name, damage):
    folder = shutil.copytree(ray_set, tmp_path / "rays")
    damage(folder / f"{name}.npy")
    with pytest.raises(InputError, match=f"{name}.npy: .* run again"):
        open_rays(folder)
