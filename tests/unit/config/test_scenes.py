"""Scenes: meshes, lights and view sets."""

import pytest

from neural_shadows.config.scenes import Scene, mesh_name


def test_view_sets_follow_from_the_ground():
    mesh = {"generate": "wyrm"}
    assert Scene(mesh=mesh).view_sets == ["shadow", "surface"]
    assert Scene(mesh=mesh, ground=False).view_sets == ["centre"]


@pytest.mark.parametrize(
    ("mesh", "name"),
    [
        ({"generate": "fence"}, "fence"),
        ({"download": "stanford_dragon"}, "stanford_dragon"),
        ({"path": "../meshes/my.dragon.ply.gz"}, "my.dragon"),
    ],
)
def test_mesh_name(mesh, name):
    assert mesh_name(Scene(mesh=mesh)) == name
