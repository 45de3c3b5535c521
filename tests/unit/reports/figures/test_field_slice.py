import json

import numpy as np
import pytest
import torch
import trimesh
from PIL import Image
from shapes import prepared

from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.field_marching import SOLID
from neural_shadows.networks.weight_file import save_network
from neural_shadows.reports.figures.field_slice import slice_logits, write_field_slice
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
    mesh, tracer = prepared(trimesh.creation.icosphere(4, radius=0.7))
    cut = slice_mesh(mesh, tracer, np.array([0.0, 1, 0]))
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
    (tmp_path / "mesh.json").write_text(json.dumps({}))
    write_field_slice(
        tmp_path / "mesh.ply",
        tmp_path / "weights.safetensors",
        tmp_path / "a.png",
        tmp_path / "a.svg",
        title="Slice",
        up="y",
    )
    with Image.open(tmp_path / "a.png") as image:
        assert np.asarray(image.convert("L"), float).std() > 10
    assert (tmp_path / "a.svg").stat().st_size < 1_000_000
