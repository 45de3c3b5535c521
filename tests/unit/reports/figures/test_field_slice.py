import numpy as np
import pytest
import torch
import trimesh
from matplotlib.image import imread
from shapes import SPHERE_OF_LIGHTS, scene_of

from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.field_marching import SOLID
from neural_shadows.networks.weight_file import save_network
from neural_shadows.reports.figures.field_slice import draw, slice_logits
from neural_shadows.reports.figures.mesh_slice import slice_mesh

SETTINGS = {"encoding": "occupancy_field", "resolution": 32, "surface": "solid", "stored": "int8"}


@pytest.fixture
def field(tmp_path):
    trimesh.creation.icosphere(4, radius=0.7).export(tmp_path / "mesh.ply")
    field = make_network(SETTINGS)
    field.prepare(tmp_path / "mesh.ply")
    field.initialise(1)
    return field


def test_what_is_held_is_at_the_surface_and_what_is_enclosed_is_inside(field):
    cut = slice_mesh(scene_of(trimesh.creation.icosphere(4, radius=0.7)))
    with torch.no_grad():
        field.values.fill_(3.0)
    logits, bricks = slice_logits(field, cut, np.zeros(2), 1.0)
    axis = (np.arange(len(logits)) + 0.5) / len(logits) * 2 - 1
    radius = np.hypot(*np.meshgrid(axis, axis))
    assert np.isfinite(logits[(radius > 0.68) & (radius < 0.695)]).all()
    assert np.nanmax(np.abs(logits - field.logits()[0].item())) < 1e-4
    assert np.isnan(logits[radius > 0.7 + 0.5]).all()
    assert (bricks[radius < 0.1] == SOLID).all() and (bricks[radius > 0.75] != SOLID).all()


def test_the_picture_is_written(tmp_path, field):
    save_network(tmp_path / "weights.safetensors", field, {"network": SETTINGS})
    files = [tmp_path / name for name in ("mesh.ply", "weights.safetensors", "a.png", "a.svg")]
    scene = {"up": "y", "ground": True, "light": SPHERE_OF_LIGHTS}
    draw(*files, title="Slice", scene=scene)
    assert imread(files[2])[..., :3].std() > 0.04
    assert files[3].stat().st_size < 1_000_000
