from shapes import SPHERE_OF_LIGHTS, box

from neural_shadows.scenes.scene import open_scene


def test_a_scene_is_opened_from_its_mesh(tmp_path):
    box(1, 1, 0.5).export(tmp_path / "mesh.ply")
    settings = {"mesh_ply": tmp_path / "mesh.ply", "light": SPHERE_OF_LIGHTS}
    scene = open_scene(up="z", ground=True, **settings)
    assert scene.up[2] == 1 and scene.ground == -0.25  # under the object
    assert open_scene(up="z", ground=False, **settings).ground is None
