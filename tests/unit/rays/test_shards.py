import json
import shutil

import numpy as np
import pytest
import trimesh
from shapes import prepared

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import sha256_of
from neural_shadows.rays import shards as ray_files
from neural_shadows.rays.describe_rays import describe_rays
from neural_shadows.rays.draw_directions import make_directions
from neural_shadows.rays.label_rays import make_labels
from neural_shadows.rays.labels import dual_bounds
from neural_shadows.rays.ray_set import RaySet, open_array
from neural_shadows.rays.sample_rays import make_rays
from neural_shadows.rays.sampling import SAMPLERS

DIRECTIONS, POINTS = 30, 400
SETTINGS = {"silhouette_resolution": 32, "min_quad": 1, "seed": 3}


@pytest.fixture(scope="module")
def shape():
    """A torus, which hides itself, with a loose sheet: rays of every kind."""
    ring = trimesh.creation.torus(0.6, 0.15, major_sections=40, minor_sections=16)
    corners = [[-0.4, 0, 0.6], [0.4, 0, 0.6], [0.4, 0.4, 0.6]]
    return ring + trimesh.Trimesh(corners, [[0, 1, 2]], process=False)


@pytest.fixture(scope="module")
def mesh_ply(shape, tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / "mesh.ply"
    path.write_bytes(shape.export(file_type="ply"))
    return path


def make_set(mesh_ply, folder, *, cuts=(0, 11, 30), threads=2, sampler="poisson_quadtree"):
    """A ray set in the folder, in shards between the cuts."""
    directions = folder / "directions.npy"
    make_directions(directions, sampler=sampler, directions=DIRECTIONS, seed=3)
    for shard, (first, last) in enumerate(zip(cuts, cuts[1:], strict=False)):
        origins = folder / f"origins.{shard:03}.npy"
        part = {"first": first, "last": last, "threads": threads}
        make_rays(
            mesh_ply,
            directions,
            origins,
            sampler=sampler,
            points_per_direction=POINTS,
            **SETTINGS,
            **part,
        )
        bounds = folder / f"bounds.{shard:03}.npy"
        make_labels(mesh_ply, directions, origins, bounds, seed=3, **part)
    return folder


@pytest.fixture(scope="module")
def ray_set(mesh_ply, tmp_path_factory):
    return make_set(mesh_ply, tmp_path_factory.mktemp("rays"))


@pytest.fixture
def copy(ray_set, tmp_path):
    """A copy that a test may damage."""
    return shutil.copytree(ray_set, tmp_path / "rays")


def everything(folder):
    rays = RaySet.in_folder(folder)
    return rays.gather(np.arange(rays.count))


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_threads_and_shards_change_no_byte(mesh_ply, tmp_path, sampler):
    layouts = [((0, 30), 1), ((0, 30), 2), ((0, 7, 8, 30), 2)]
    contents = []
    for i, (cuts, threads) in enumerate(layouts):
        folder = tmp_path / str(i)
        folder.mkdir()
        make_set(mesh_ply, folder, cuts=cuts, threads=threads, sampler=sampler)
        contents.append([array.tobytes() for array in everything(folder)])
    assert contents[1] == contents[0]
    assert contents[2] == contents[0]


def test_seeds_and_directions_differ(mesh_ply, ray_set, tmp_path):
    origins = RaySet.in_folder(ray_set).origins[0]
    # The same direction twice: its points are drawn anew for each index.
    directions = np.repeat(np.array([[0, 0, 1]], np.float32), 2, axis=0)
    np.save(tmp_path / "directions.npy", directions)
    options = {"sampler": "uniform", "points_per_direction": 50, "first": 0, "last": 2}
    drawn = []
    for seed in (3, 4):
        out = tmp_path / f"{seed}.npy"
        settings = SETTINGS | options | {"seed": seed, "threads": 1}
        make_rays(mesh_ply, tmp_path / "directions.npy", out, **settings)
        drawn += [*np.load(out)]
    assert len({points.tobytes() for points in drawn}) == 4
    assert not np.array_equal(origins[0], origins[1])


def test_rays_of_a_set_are_as_the_contract_says(ray_set, shape):
    rays = RaySet.in_folder(ray_set)
    assert rays.count == DIRECTIONS * POINTS
    assert rays.points_per_direction == POINTS
    assert [len(origins) for origins in rays.origins] == [11, 19]
    origins, directions, t_lb, t_ub = everything(ray_set)
    assert all(array.dtype == np.float32 for array in (origins, directions, t_lb, t_ub))
    assert np.array_equal(directions, np.repeat(rays.directions, POINTS, axis=0))
    cosines = np.sum(origins.astype(float) * directions, axis=1)
    assert np.abs(np.linalg.norm(origins.astype(float), axis=1) - 1).max() < 1e-6
    assert np.abs(np.linalg.norm(directions.astype(float), axis=1) - 1).max() < 1e-6
    assert (cosines < 0).all()
    assert ((t_lb > 0) & (t_lb <= -2 * cosines + 1e-6) & (t_lb <= t_ub)).all()
    expected = dual_bounds(prepared(shape)[1], origins, directions)
    assert np.array_equal([t_lb, t_ub], expected)


def test_gather_finds_rays_across_shards(ray_set):
    rays = RaySet.in_folder(ray_set)
    whole = everything(ray_set)
    indices = np.random.default_rng(0).integers(rays.count, size=5000)
    for found, stored in zip(rays.gather(indices), whole, strict=True):
        assert np.array_equal(found, stored[indices])
    edges = np.array([11 * POINTS, 11 * POINTS - 1, rays.count - 1, 0])
    for found, stored in zip(rays.gather(edges), whole, strict=True):
        assert np.array_equal(found, stored[edges])
    assert [len(array) for array in rays.gather(np.array([], np.int64))] == [0] * 4
    for wrong in (rays.count, -1):
        with pytest.raises(IndexError, match="12000"):
            rays.gather(np.array([0, wrong]))


def wrong_once(*arguments):
    """`dual_bounds`, but for a NaN at the ray 123 of the third task."""
    t_lb, t_ub = dual_bounds(*arguments)
    wrong_once.tasks += 1
    if wrong_once.tasks == 3:
        t_lb[123] = np.nan
    return t_lb, t_ub


def half_of_the_tasks(task, directions, *_):
    """`_run_tasks`, but for a second half that is never done: the file has zeros there."""
    task(0, directions // 2)


@pytest.mark.parametrize(
    ("name", "stand_in", "ray", "values"),
    [
        ("dual_bounds", wrong_once, f"ray 123 of direction {11 + 2 * 4}", "t_lb = nan, t_ub = "),
        ("_run_tasks", half_of_the_tasks, f"ray 0 of direction {11 + 9}", "t_lb = 0.0, t_ub = 0"),
    ],
)
def test_a_shard_with_impossible_bounds_stops_the_run(
    mesh_ply, copy, monkeypatch, name, stand_in, ray, values
):
    monkeypatch.setattr(ray_files, name, stand_in)
    monkeypatch.setattr(ray_files, "_TASK_RAYS", 4 * POINTS)
    wrong_once.tasks = 0
    bounds = copy / "bounds.001.npy"
    bounds.unlink()
    before = sorted(copy.iterdir())
    with pytest.raises(RuntimeError) as caught:
        make_labels(
            mesh_ply,
            copy / "directions.npy",
            copy / "origins.001.npy",
            bounds,
            seed=3,
            first=11,
            last=30,
            threads=1,
        )
    message = str(caught.value)
    assert message.startswith(f"labels {bounds} (seed 3): {ray} from [")
    assert values in message
    assert sorted(copy.iterdir()) == before  # no shard, and no part of one


def test_the_description_counts_rays_by_their_hits(mesh_ply, ray_set, tmp_path):
    path = tmp_path / "rays.json"
    content = describe_rays(
        path,
        mesh_ply=mesh_ply,
        directions_npy=ray_set / "directions.npy",
        origins_npys=[ray_set / f"origins.00{i}.npy" for i in (0, 1)],
        bounds_npys=[ray_set / f"bounds.00{i}.npy" for i in (0, 1)],
        sampler="poisson_quadtree",
        **SETTINGS,
    )
    assert json.loads(path.read_text()) == content
    origins, directions, t_lb, t_ub = everything(ray_set)
    chord = -2 * np.sum(origins.astype(float) * directions, axis=1)
    missed = np.isinf(t_ub) & (np.abs(t_lb - chord) < 1e-6)
    assert 0.1 < content["misses"] == pytest.approx(missed.mean(), abs=1e-12)
    once = np.isinf(t_ub) & ~missed
    assert 0.001 < content["one_hit"] == pytest.approx(once.mean(), abs=1e-12)
    assert content["mesh_sha256"] == sha256_of(mesh_ply)
    assert len(content["sha256"]) == 5
    for file, digest in content["sha256"].items():
        assert digest == sha256_of(ray_set / file)
    assert (content["directions"], content["points_per_direction"]) == (DIRECTIONS, POINTS)
    assert content["rays"] == DIRECTIONS * POINTS and content["shards"] == 2
    assert content["second_hit_step"] == 2e-5
    assert content["seed"] == 3 and content["silhouette_resolution"] == 32


def truncate(path):
    path.write_bytes(path.read_bytes()[:-100])


def empty(path):
    path.write_bytes(b"")


def foreign(path):
    path.write_text("t_lb,t_ub\n0,1\n")


def pickled(path):
    np.save(path, np.array([{}], dtype=object), allow_pickle=True)


def as_float64(path):
    np.save(path, np.load(path).astype(np.float64))


def flat(path):
    np.save(path, np.load(path).reshape(-1, np.load(path).shape[-1]).ravel())


def one_less(path):
    np.save(path, np.load(path)[:-1])


DAMAGES = [truncate, empty, foreign, pickled, as_float64, flat, one_less]


@pytest.mark.parametrize("name", ["directions", "origins.001", "bounds.000"])
@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_files_are_named(copy, name, damage):
    path = copy / f"{name}.npy"
    damage(path)
    with pytest.raises(InputError, match="delete .* and run again") as caught:
        RaySet.in_folder(copy)
    # A shard that lost directions may be missed at the directions or at its bounds.
    blamed = [name] if damage is not one_less else [name, "directions", "bounds"]
    assert any(part in str(caught.value) for part in blamed)
    assert "\n" not in str(caught.value)


def test_missing_files_are_named(copy):
    (copy / "bounds.001.npy").unlink()
    with pytest.raises(InputError, match="2 origins and 1 bounds files"):
        RaySet.in_folder(copy)
    (copy / "directions.npy").unlink()
    with pytest.raises(InputError, match="directions.npy: no such file"):
        RaySet.in_folder(copy)


def test_wrong_arguments_are_named(mesh_ply, ray_set, tmp_path):
    directions, out = ray_set / "directions.npy", tmp_path / "out.npy"
    right = SETTINGS | {"sampler": "uniform", "points_per_direction": 5}
    right |= {"first": 0, "last": 30, "threads": 1}
    wrong = [
        ({"last": 31}, "0 to 31 is no range of the 30 directions"),
        ({"first": 30}, "30 to 30"),
        ({"points_per_direction": 0}, "points_per_direction: 0"),
        ({"sampler": "sobol"}, "sampler: 'sobol'"),
    ]
    for change, message in wrong:
        with pytest.raises(InputError, match=message):
            make_rays(mesh_ply, directions, out, **right | change)
    with pytest.raises(InputError, match="no such file"):
        make_rays(tmp_path / "none.ply", directions, out, **right)
    with pytest.raises(ValueError, match="no power of two"):
        make_rays(
            mesh_ply,
            directions,
            out,
            **right | {"sampler": "uniform_quadtree", "silhouette_resolution": 48},
        )
    # The labels of a range need the origins of that range.
    with pytest.raises(InputError, match=r"origins.001.npy: holds .*\(19, 400, 3\)"):
        origins = ray_set / "origins.001.npy"
        make_labels(mesh_ply, directions, origins, out, seed=3, first=0, last=11, threads=1)
    assert list(tmp_path.iterdir()) == []  # nothing half-written is left


def test_no_bit_of_an_array_s_header_gives_an_unclear_error(tmp_path):
    path = tmp_path / "origins.000.npy"
    np.save(path, np.ones((6, 5, 3), np.float32))
    whole = path.read_bytes()
    refused = 0
    for bit in range(8 * 128):
        changed = bytearray(whole)
        changed[bit // 8] ^= 1 << bit % 8
        path.write_bytes(changed)
        try:
            open_array(path, (None, 5, 3))
        except InputError as error:
            assert str(path) in str(error) and "\n" not in str(error)
            refused += 1
    assert refused > 500
