import numpy as np
import pytest
import trimesh
from shapes import SPHERE_OF_LIGHTS, Y_UP, box, scene_of

from neural_shadows.errors import InputError
from neural_shadows.scenes.scene import open_scene


def test_ground_lies_under_the_object_along_up():
    shape = box(1, 1, 0.5)
    assert scene_of(shape, up=np.array([0.0, 0.0, 1.0])).ground == -0.25
    assert scene_of(shape).ground == -0.5
    assert scene_of(shape, ground=False).ground is None


def test_a_scene_is_opened_from_its_mesh(tmp_path):
    trimesh.creation.icosphere(2).export(tmp_path / "mesh.ply")
    settings = {"ground": True, "light": SPHERE_OF_LIGHTS}
    scene = open_scene(tmp_path / "mesh.ply", up="y", **settings)
    np.testing.assert_array_equal(scene.up, Y_UP)
    assert len(scene.objects[0].faces) == 320
    down = np.array([[0, -1, 0]], np.float32)
    assert scene.tracer.occluded(-2 * down, down).all()
    with pytest.raises(InputError, match="up: '\\+y' is not an axis"):
        open_scene(tmp_path / "mesh.ply", up="+y", **settings)
