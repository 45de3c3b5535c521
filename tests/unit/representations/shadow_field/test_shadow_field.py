"""A field as a user has it: fitted to a mesh in its own place, asked by every door."""

import numpy as np
import pytest
import trimesh
from shapes import bumpy_sphere, sheet

from neural_shadows import InputError, ShadowField
from neural_shadows.representations.distance_bricks.field_cones import half_disc
from neural_shadows.representations.shadow_field.shadow_field import FEW
from neural_shadows.scenes.tracing import Tracer

PLACE, SIZE = np.array([4e5, -7.0, 5.2e6]), 30.0  # metres, as a map has them
UP, ASLANT = np.array([0.0, 1.0, 0.0]), np.array([2.0, 1.5, -0.5])


def in_place(shape: trimesh.Trimesh) -> trimesh.Trimesh:
    return trimesh.Trimesh(shape.vertices * SIZE + PLACE, shape.faces, process=False)


@pytest.fixture(scope="module")
def bumps():
    shape = bumpy_sphere(5)
    return shape, ShadowField.fit(in_place(shape), resolution=128)


def around(count, reach=1.0, seed=0):
    return np.random.default_rng(seed).uniform(-reach, reach, (count, 3))


def exact(shape, points, to_light):
    tracer = Tracer(np.float32(shape.vertices), np.int32(shape.faces))
    return tracer.occluded(np.float32(points), np.float32(np.broadcast_to(to_light, points.shape)))


def test_points_behind_a_ball_are_dark():
    field = ShadowField.fit(in_place(trimesh.creation.icosphere(5, radius=0.8)), resolution=128)
    points = around(50_000, 1.5)
    along = points @ ASLANT / np.linalg.norm(ASLANT)
    across = np.sqrt((points**2).sum(1) - along**2)
    behind = (across < 0.8) & (along < np.sqrt(np.maximum(0.8**2 - across**2, 0)))
    assert np.mean(field.occluded(points * SIZE + PLACE, 7 * ASLANT) != behind) < 0.002
    assert (field.resolution, field.sheet) == (128, False)
    assert field.cell == pytest.approx(2 * 0.8 * SIZE / 128, rel=1e-3)


def test_every_way_to_ask_has_the_same_answers(bumps):
    shape, field = bumps
    points = around(1_000_000, 1.2)
    places = points * SIZE + PLACE
    occluded = field.occluded(places, ASLANT)
    assert 0.2 < occluded.mean() < 0.8
    assert np.mean(occluded != exact(shape, points, ASLANT)) < 0.001
    others = {
        "far": field.occluded_from(places, PLACE + 1e7 * ASLANT),
        "rays": field.intersects_any(places, np.tile(ASLANT, (len(points), 1))),
        "open3d": field.test_occlusions(np.concatenate([places, np.tile(ASLANT, (len(points), 1))], 1)),
    }  # fmt: skip
    for name, answers in others.items():
        assert np.mean(answers != occluded) < 0.001, name
    # Of few points no tables are built for the light.
    few = (field.resolution**2 - 1) // FEW
    parts = [field.occluded(places[k : k + few], ASLANT) for k in range(0, 20 * few, few)]
    assert np.mean(np.concatenate(parts) != occluded[: 20 * few]) < 0.001


def test_rays_in_all_directions(bumps):
    shape, field = bumps
    origins, directions = around(100_000), around(100_000, seed=1)
    found = field.intersects_any(origins * SIZE + PLACE, directions)
    assert np.mean(found != exact(shape, origins, directions)) < 0.004


def test_a_light_within_the_scene(bumps):
    shape, field = bumps
    points, light = around(100_000), np.array([0.1, 1.1, 0.3])
    tracer = Tracer(np.float32(shape.vertices), np.int32(shape.faces))
    blocked = tracer.blocked(np.float32(points), np.float32(light - points))
    found = field.occluded_from(points * SIZE + PLACE, light * SIZE + PLACE)
    assert 0.2 < blocked.mean() < 0.8 and np.mean(found != blocked) < 0.004


def test_rays_between_two_distances(bumps):
    """As Open3D counts them: in lengths of the directions."""
    _, field = bumps
    down = np.array([0.0, -3.0, 0.0])
    above = np.array([[0.0, 2.0, 0.0]]) * SIZE + PLACE
    rays = np.concatenate([above, [down * SIZE]], axis=1).reshape(1, 1, 6)
    to_surface = (2 - 0.85) / 3  # about: of bumps of 0.1
    ends = [(0, np.inf, True), (0, to_surface - 0.05, False), (0, to_surface + 0.05, True)]
    ends += [(1.1, np.inf, False), (0.5, np.inf, True), (0.5, 0.6, True)]
    for tnear, tfar, expected in ends:
        found = field.test_occlusions(rays, tnear, tfar)
        assert found.shape == (1, 1) and found[0, 0] == expected, (tnear, tfar)


def test_segments_of_no_length(bumps):
    """None is blocked, not even inside."""
    _, field = bumps
    rays = np.concatenate([around(100) * SIZE + PLACE, around(100, seed=1)], axis=1)
    for tnear, tfar in ((0, 0), (1, 1), (2, 1), (0, np.nan)):
        assert not field.test_occlusions(rays, tnear, tfar).any()
    blocked = np.zeros(100, bool)
    for segment in (0, np.nan, np.inf):
        field.block(rays[:, :3], np.full((100, 3), segment), blocked)
        assert not blocked.any()


@pytest.mark.parametrize("length", [1e-200, 1e-30, 1e30, 1e200])
def test_directions_of_any_length(bumps, length):
    """Also where squares of lengths are 0 or infinite."""
    _, field = bumps
    places, directions = around(20_000) * SIZE + PLACE, around(20_000, seed=1)
    assert np.mean(
        field.intersects_any(places, length * directions)
        != field.intersects_any(places, directions)
    ) < 1e-4  # fmt: skip
    assert np.array_equal(field.occluded(places, length * UP), field.occluded(places, UP))
    rays, same = (np.concatenate([places, d], axis=1) for d in (length * directions, directions))
    few = field.test_occlusions(rays, 0, SIZE / length) != field.test_occlusions(same, 0, SIZE)
    assert np.mean(few) < 1e-4


@pytest.mark.parametrize("away", [1e5, 1e12, 1e20, 1e30, 1e38])
def test_points_and_lamps_far_away(bumps, away):
    """A lamp's rays are the sun's; points are lit, and change no others."""
    _, field = bumps
    places = around(20_000) * SIZE + PLACE
    lamp = field.occluded_from(places, away * SIZE * ASLANT + PLACE)
    assert np.mean(lamp != field.occluded(places, ASLANT)) < 0.001
    far = away * SIZE * np.concatenate([ASLANT[None], around(100)]) + PLACE
    for answers in (
        field.occluded(far, ASLANT),
        field.occluded(np.resize(far, (20_000, 3)), ASLANT),
        field.intersects_any(far, around(101, seed=1)),
    ):
        assert not answers.any()
    with_far = field.soft(np.concatenate([places, far]), ASLANT, 1.0)
    assert np.array_equal(with_far[: len(places)], field.soft(places, ASLANT, 1.0))
    assert np.all((with_far >= 0) & (with_far <= 1))


@pytest.mark.parametrize("angular_radius, away", [(0.27, 1e4), (5, 100), (5, 1e4), (40, 10)])
def test_an_object_far_from_its_shadow_hides_little_of_a_light(angular_radius, away):
    """Of a ball's diameter across the light's; distances were extrapolated, and all was dark."""
    field = ShadowField.fit(trimesh.creation.icosphere(4), 64)
    behind = around(1000) - away * ASLANT / np.linalg.norm(ASLANT)
    visible = field.soft(behind, ASLANT, angular_radius)
    hidden = (1 / (away * np.tan(np.radians(angular_radius)))) ** 2
    assert np.abs(visible - (1 - hidden)).mean() < 0.1


@pytest.mark.parametrize("angular_radius", [1e-300, 1e-30, 1e-9, 1.1e-4])
def test_a_light_of_hardly_any_radius_is_a_point(bumps, angular_radius):
    _, field = bumps
    places = around(20_000) * SIZE + PLACE
    visible = field.soft(places, ASLANT, angular_radius)
    assert np.mean(visible != 1 - field.occluded(places, ASLANT)) < 0.01


@pytest.mark.parametrize("open_mesh", [False, True])
def test_a_round_light_past_a_straight_edge(open_mesh):
    """Half a plane covers a disc up to a straight line, and so does the rim of a slab."""
    slab = sheet(0.0, 2.0) if open_mesh else trimesh.creation.box((4, 0.2, 4))
    field = ShadowField.fit(slab, resolution=256)
    assert field.sheet == open_mesh
    below = 3.0
    penumbra = below * np.tan(np.radians(5.0))
    m = np.linspace(-1.5, 1.5, 200)
    points = np.stack([2 + m * penumbra, np.full(200, -below), np.zeros(200)], axis=1)
    expected = np.array([half_disc(each) for each in m])
    errors = np.abs(field.soft(points, UP, 5.0) - expected)
    assert errors.max() < 0.09 and errors.mean() < 0.025
    assert np.array_equal(field.soft(points, UP, 0), ~field.occluded(points, UP))


@pytest.mark.parametrize("winding", [1, -1])
def test_a_sheet_occludes_on_both_sides_up_to_its_border(winding):
    field = ShadowField.fit(sheet(0.3, 0.5, winding), resolution=64)
    assert field.sheet
    points = around(100_000)
    covered = (np.abs(points[:, [0, 2]]) < 0.5).all(axis=1)
    clear = np.abs(points[:, 1] - 0.3) > field.cell  # a point on it sees either side
    at_rim = np.abs(np.abs(points[:, [0, 2]]).max(axis=1) - 0.5) < 1.2 * field.cell
    for side in (1, -1):
        occluded = field.occluded(points, side * UP)
        expected = covered & (side * (0.3 - points[:, 1]) > 0)
        assert np.array_equal(occluded[clear & ~at_rim], expected[clear & ~at_rim])


def test_a_hill_shadows_its_foot_and_is_open():
    """A height field, against Embree on the same points."""
    side = np.linspace(-1, 1, 200)
    x, z = np.meshgrid(side, side, indexing="ij")
    y = 0.5 * np.exp(-8 * (x**2 + z**2)) + 0.03 * np.sin(20 * x) * np.sin(17 * z)
    corner = np.arange(200 * 200).reshape(200, 200)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    faces = np.stack([a, d, b, b, d, c], axis=-1).reshape(-1, 3)
    hill = trimesh.Trimesh(np.stack([x, y, z], -1).reshape(-1, 3), faces, process=False)
    field = ShadowField.fit(hill)
    points, face = trimesh.sample.sample_surface(hill, 50_000, seed=0)
    points += 0.15 * field.cell * hill.face_normals[face]
    low_sun = np.array([1.0, 0.25, 0.4])
    occluded, expected = field.occluded(points, low_sun), exact(hill, points, low_sun)
    assert field.sheet and 0.2 < expected.mean() < 0.8
    assert np.mean(occluded != expected) < 0.01


def test_points_inside_a_solid_are_dark(bumps):
    _, field = bumps
    assert field.occluded(PLACE + 0.5 * SIZE * around(1000, 0.5), ASLANT).all()


def test_meshes_in_any_form_give_the_same_field(tmp_path):
    shape = in_place(bumpy_sphere(3))
    shape.export(tmp_path / "mesh.glb")
    as_file = trimesh.load_mesh(tmp_path / "mesh.glb", process=False)  # of float32
    forms = [tmp_path / "mesh.glb", str(tmp_path / "mesh.glb"), as_file, trimesh.Scene([as_file])]
    forms += [
        (as_file.vertices, as_file.faces),
        (as_file.vertices.tolist(), as_file.faces.tolist()),
    ]
    fields = [ShadowField.fit(form, resolution=32) for form in forms]
    for field in fields[1:]:
        assert np.array_equal(field.bricks, fields[0].bricks)
        assert np.array_equal(field.centre, fields[0].centre) and field.radius == fields[0].radius


def test_meshes_that_cross_themselves_are_answered():
    """Two balls, one in the other's side, as modellers leave them."""
    pair = [trimesh.creation.icosphere(4, radius=0.5) for _ in range(2)]
    pair[1].apply_translation([0.6, 0, 0])
    shape = trimesh.util.concatenate(pair)
    field = ShadowField.fit(shape, resolution=64)
    points = around(20_000, 1.2)
    assert np.mean(field.occluded(points, ASLANT) != exact(shape, points, ASLANT)) < 0.005


BAD_RAYS = {
    "(0, 2)": (np.zeros((5, 2)), UP, r"points: shape \(5, 2\): not \(n, 3\)"),
    "one": (np.zeros(3), UP, r"points: shape \(3,\): not \(n, 3\)"),
    "text": ([["a", "b", "c"]], UP, "points: list: no numbers"),
    "NaN": ([[0, 0, 0], [0, np.nan, 0]], UP, r"points: row 1 .* is \[0.0, nan, 0.0\]: not finite"),
    "∞": ([[0, -np.inf, 0]], UP, "points: row 0 .* not finite"),
    "beyond float32": ([[0, 0, 0], [0, 1e300, 0]], UP, "points: row 1 .* not finite in float32"),
    "zero": (np.zeros((1, 3)), [0, 0, 0], "direction: .* has no direction"),
    "many": (np.zeros((2, 3)), np.ones((2, 3)), r"direction: shape \(1, 2, 3\)|direction: shape"),
    "NaN direction": (np.zeros((1, 3)), [0, np.nan, 0], "direction: .*: not finite"),
}


@pytest.mark.parametrize("name", BAD_RAYS)
def test_bad_rays_are_refused_in_one_line(bumps, name):
    points, direction, message = BAD_RAYS[name]
    with pytest.raises(InputError, match=message) as error:
        bumps[1].occluded(points, direction)
    assert "\n" not in str(error.value)


def test_other_bad_arguments(bumps):
    _, field = bumps
    points = np.zeros((2, 3))
    with pytest.raises(InputError, match=r"angular_radius: 60: not in \[0, 45\)"):
        field.soft(points, UP, 60)
    with pytest.raises(InputError, match="ray_directions: 1 rows for 2 origins"):
        field.intersects_any(points, [UP])
    with pytest.raises(
        InputError, match=r"ray_directions: row 1 \(counted from 0\): has no direction"
    ):
        field.intersects_any(points, [UP, [0, 0, 0]])
    with pytest.raises(InputError, match=r"rays: shape \(2, 3\): not \(n, 6\)"):
        field.test_occlusions(points)
    with pytest.raises(InputError, match="position: .*: not finite"):
        field.occluded_from(points, [0, np.inf, 0])
    for resolution in (0, 10, 2000, 256.5, "256"):
        with pytest.raises(InputError, match="resolution: .*: not a multiple of 4 from 8 to 1024"):
            ShadowField.fit(trimesh.creation.box(), resolution)


def test_no_points_have_no_answers(bumps):
    _, field = bumps
    nothing = np.zeros((0, 3))
    for answers in (
        field.occluded(nothing, UP),
        field.occluded_from(nothing, UP),
        field.soft(nothing, UP, 1),
        field.intersects_any(nothing, nothing),
        field.test_occlusions(np.zeros((0, 6))),
    ):
        assert answers.shape == (0,)


SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
BAD_MESHES = {
    "quads": ((SQUARE, [[0, 1, 2, 3]]), r"faces: int64 \(1, 4\): not \(n, 3\) integers"),
    "floats": ((SQUARE, [[0.0, 1, 2]]), "faces: float64 .* not .* integers"),
    "beyond": ((SQUARE, [[0, 1, 4]]), "faces: indices from 0 to 4, of 4 vertices"),
    "plane": ((SQUARE[:, :2], [[0, 1, 2]]), r"vertices: float64 \(4, 2\): not \(n, 3\)"),
    "none": ((SQUARE, np.zeros((0, 3), int)), "faces: none"),
    "NaN": ((SQUARE * [1, np.nan, 1], [[0, 1, 2]]), "vertex 0 .* not finite. Repair the mesh"),
    "flat": ((SQUARE[[0, 1, 1]], [[0, 1, 2]]), "zero area"),
    "number": (7, "mesh: a int. Give a path, a trimesh.Trimesh, or"),
    "path": ("no/such.ply", "mesh no/such.ply: cannot be read"),
}


@pytest.mark.parametrize("name", BAD_MESHES)
def test_bad_meshes_are_refused_in_one_line(name):
    mesh, message = BAD_MESHES[name]
    with pytest.raises(InputError, match=message) as error:
        ShadowField.fit(mesh)
    assert "\n" not in str(error.value)
