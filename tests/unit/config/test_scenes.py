"""Scenes: meshes, lights and view sets."""

import pytest

from neural_shadows.config.scenes import Scene, mesh_name

MISTAKES = [
    ("dragon.mesh", "wyrm", "scenes.dragon.mesh = 'wyrm': should be one of {generate: wyrm, fence"),
    ("dragon.mesh.path", "x.ply", "(an overlay drops a key of the default by setting it to null)"),
    ("dragon.mesh.cels", 3, "scenes.dragon.mesh: unknown key: 'cels' (did you mean 'cells'?)"),
    ("dragon.mesh.generate", "dog", "= {'generate': 'dog'}: should be one of"),
    ("dragon.light.domain", "disk", "`domain` should be one of sphere, single_axis"),
    ("dragon.light.axis", "x", "scenes.dragon.light: unknown key: 'axis'"),
    ("landscape.light.axis", "y", "must be horizontal, not `up`; allowed: x, z"),
    ("landscape.view_sets", ["shadow"], "'shadow' needs a scene with ground: true"),
    ("dragon.view_sets", ["surface"] * 2, "must name each only once"),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES, ids=lambda part: str(part)[:40])
def test_mistakes(message, key, value, words):
    assert words in message(f"scenes.{key}", value)


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
