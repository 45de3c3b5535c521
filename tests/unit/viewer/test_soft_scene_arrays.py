"""A scene's arrays for the soft viewer: which triangles stay, and where they are."""

import numpy as np
import pytest

from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.viewer.soft_scene_arrays import FIELD_CELL, _kept, shown_fields, shown_scene


@pytest.fixture(scope="module")
def room():
    return SoftScene({"generate": "room", "seed": 5, "inserted": {}}, [])


def test_all_triangles_stay_where_they_fit(room):
    _, shown, whole = shown_scene(room, 500_000)
    assert shown == whole == len(room.at_rest.joined.faces)


def test_large_objects_give_up_triangles(room):
    """Never more than asked; small objects stay whole."""
    counts = np.array([12, 250, 4_000, 64_000])
    kept = _kept(counts, 10_000)
    assert 9_900 <= kept.sum() <= 10_000
    assert kept[:2].tolist() == [12, 250]
    assert kept[3] / kept[2] == pytest.approx(4, rel=0.01)  # by the roots of 16
    whole = len(room.at_rest.joined.faces)
    _, shown, _ = shown_scene(room, whole // 2)
    assert 0.4 * whole <= shown < 0.9 * whole  # objects of many pieces keep more


def test_bounds_lie_within_the_scene(room):
    data, _, _ = shown_scene(room, 500_000)
    low, high = np.array(data["bounds"])
    vertices = room.at_rest.joined.vertices
    assert np.all(vertices.min(0) < low) and np.all(high < vertices.max(0))
    assert data["mover"] == room.arrangement.mover_index


def test_closed_objects_have_fields_in_their_places(room):
    scene = room.at_rest
    fields = shown_fields(scene)
    assert fields["cell"] == FIELD_CELL * scene.size
    names = [part.name for part in room.arrangement.objects]
    held = {name: field for name, field in zip(names, fields["objects"]) if field}
    assert names[0] == "floor" and fields["objects"][0] is None  # two triangles have no inside
    vase = scene.objects[names.index("vase")].vertices
    reach = np.linalg.norm(vase - np.array(held["vase"]["centre"]), axis=1)
    assert reach.max() < held["vase"]["radius"] < 1.1 * reach.max()
