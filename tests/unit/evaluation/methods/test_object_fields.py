"""Ways to a light through fields of objects, beside the triangles."""

import numpy as np
import pytest
import trimesh
from shapes import prepared, sheet

from neural_shadows.errors import InputError
from neural_shadows.evaluation.method_parts import scene_fields
from neural_shadows.evaluation.method_parts.object_field import (
    StoredFields,
    fitted_field,
    write_fields,
)
from neural_shadows.evaluation.method_parts.scene_fields import SceneFields, fields_in, take_stored
from neural_shadows.scenes.scene import make_scene

UP = np.array([0.0, 1.0, 0.0])


def some_ways(count, reach):
    """From points round the origin to others: some end before they are through."""
    rng = np.random.default_rng(3)
    points = rng.normal(size=(count, 3))
    points *= reach / np.linalg.norm(points, axis=1, keepdims=True)
    goals = rng.normal(size=(count, 3)) * reach / 2
    return points.astype(np.float32), (goals - points).astype(np.float32)


@pytest.mark.parametrize(
    "shape", [trimesh.creation.icosphere(4), trimesh.creation.box((1.2, 0.3, 0.8))]
)
def test_a_field_blocks_what_its_object_does(shape):
    shape.apply_translation([2.0, -1.0, 0.5])
    mesh, tracer = prepared(shape)
    points, ways = some_ways(20_000, 2.5)
    points += np.array([2.0, -1.0, 0.5], np.float32)
    blocked = np.zeros(len(points), bool)
    fitted_field(mesh, 0.02).block(points, ways, blocked)
    exact = tracer.blocked(points, ways)
    assert 0.05 < exact.mean() < 0.9
    assert np.mean(blocked != exact) < 0.01  # those that graze it, or end at it


def test_convex_edges_are_not_cut_off():
    """By distances as they are, 4.5 in 1000 of these ways pass through the edges of a box of 8 cells."""
    mesh, tracer = prepared(trimesh.creation.box((1.2, 0.3, 0.8)))
    points, ways = some_ways(50_000, 2.5)
    blocked = np.zeros(len(points), bool)
    fitted_field(mesh, 0.05).block(points, ways, blocked)
    assert np.mean(blocked != tracer.blocked(points, ways)) < 0.0025


def test_a_vertex_of_each_face_makes_no_edges():
    """As generated objects have them: their faces' diagonals are no edges, nor are the edges open."""
    box = trimesh.creation.box((1.2, 0.3, 0.8))
    apart = trimesh.Trimesh(
        box.triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3), process=False
    )
    fields = [fitted_field(prepared(shape)[0], 0.05) for shape in (box, apart)]
    assert np.array_equal(fields[0].bricks, fields[1].bricks)


def test_what_is_blocked_stays_blocked():
    mesh, _ = prepared(trimesh.creation.icosphere(2))
    points, ways = some_ways(500, 3.0)
    blocked = np.ones(500, bool)
    fitted_field(mesh, 0.1).block(points, ways, blocked)
    assert blocked.all()


def test_open_objects_are_traced_as_they_are():
    """Two boxes that share an edge are closed, a sheet is not."""
    pair = [trimesh.creation.box((1, 1, 1)) for _ in range(2)]
    pair[1].apply_translation([1, 1, 0])
    meshes = [prepared(trimesh.util.concatenate(pair))[0], prepared(sheet(-2.0, 3.0))[0]]
    scene = make_scene(*meshes, up=UP, ground=False, light=None)
    fields = SceneFields(scene)
    assert len(fields.fields) == 1 and fields.tracer is not None
    points, ways = some_ways(5000, 4.0)
    found, exact = fields.blocked(points, ways), scene.tracer.blocked(points, ways)
    assert np.mean(found != exact) < 0.01 and 0.05 < exact.mean() < 0.95


@pytest.fixture
def nothing_kept(monkeypatch):
    """Neither fields of other tests, nor files."""
    monkeypatch.setattr(scene_fields, "_cache", {})
    monkeypatch.setattr(scene_fields, "_stored", [])


def test_stored_fields_are_taken_and_answer_alike(tmp_path, nothing_kept, monkeypatch):
    mesh, _ = prepared(trimesh.creation.box((1.2, 0.3, 0.8)))
    scene = make_scene(mesh, prepared(sheet(-2.0, 3.0))[0], up=UP, ground=False, light=None)
    points, ways = some_ways(5000, 2.5)
    fitted = SceneFields(scene)
    write_fields(tmp_path / "fields.npz", fields_in(scene))
    take_stored([tmp_path / "fields.npz"])
    scene_fields._cache.clear()
    monkeypatch.setattr(scene_fields, "fitted_field", lambda mesh, cell: None)  # of the sheet
    stored = SceneFields(scene)
    assert len(stored.fields) == 1
    assert np.array_equal(stored.fields[0].bricks, fitted.fields[0].bricks)
    assert np.array_equal(stored.blocked(points, ways), fitted.blocked(points, ways))


def test_a_damaged_file_of_fields_names_itself(tmp_path):
    path = tmp_path / "fields.npz"
    path.write_bytes(b"PK\x03\x04 no archive")
    with pytest.raises(InputError, match=r"fields\.npz: damaged .* Delete it"):
        StoredFields(path)
