"""The figure of a forest: its shadows by fields are nearly those by triangles."""

import numpy as np
import pytest
from matplotlib.image import imread
from shapes import Y_UP, box, bumpy_sphere

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import write_json
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.object_space.field_instances import FieldInstances
from neural_shadows.networks.object_space.untrained_field import untrained_field
from neural_shadows.rendering.shading import AMBIENT, BACKGROUND
from neural_shadows.reports.figures import forest
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.mesh_instances import MeshInstances

TOLD = {"title": "Some", "instances": 5, "resolution": 64, "seed": 3, "run": {"scale": "test"}}


@pytest.fixture
def files(tmp_path):
    meshes, reports = ([tmp_path / f"{k}.{end}" for k in range(2)] for end in ("ply", "json"))
    for mesh, report, shape in zip(meshes, reports, (bumpy_sphere(3), box(0.9, 0.3, 1.3))):
        shape.export(mesh)
        write_json(report, {"sheet": False})
    return meshes, reports


def test_a_box_on_the_plain_throws_its_shadow_away_from_the_light(files, monkeypatch):
    monkeypatch.setattr(forest, "WIDTH", 150)
    monkeypatch.setattr(forest, "HEIGHT", 100)
    path = files[0][1]
    placed = np.zeros(1, int), np.eye(4)[None]
    exact = MeshInstances([read_prepared(path)], *placed)
    fields = FieldInstances([untrained_field(path, 64)], *placed)
    above = Camera(np.array([0.0, 9.0, 0.01]), np.zeros(3), Y_UP, 40.0)
    for lamp, side in ((None, -1), (np.array([-2.0, 0.5, 0.0]), 1)):
        found = forest.shadows("One", exact, fields, above, lamp)
        assert found.false_shadow < 0.01 and found.leak < 0.01
        assert np.mean(found.exact != found.by_fields) == pytest.approx(
            found.false_shadow + found.leak, abs=0.01
        )
        dark = np.argwhere(found.exact == np.float32(AMBIENT))[:, 1] - 75
        assert (
            len(dark) > 50 and np.sign(dark.mean()) == side and found.exact.max() < BACKGROUND + 0.2
        )


def test_a_forest_is_drawn_and_a_sheet_is_refused(files, tmp_path, monkeypatch):
    monkeypatch.setattr(forest, "WIDTH", 90)
    monkeypatch.setattr(forest, "HEIGHT", 60)
    png, svg = tmp_path / "f.png", tmp_path / "f.svg"
    forest.draw(*files, png, svg, ups=["y", "z"], **TOLD)
    assert imread(png)[..., :3].std() > 0.02 and svg.stat().st_size > 1000
    write_json(files[1][0], {"sheet": True})
    with pytest.raises(InputError, match="0.ply: open and thin, .* leave it out"):
        forest.draw(*files, png, svg, ups=["y", "z"], **TOLD)
