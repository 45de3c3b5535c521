"""Figures in 3D and of fields."""

import numpy as np
import pytest
import torch
import trimesh
from built_networks import make_network
from shapes import Y_UP, scene_of

from neural_shadows.evaluation.references import References, write_references
from neural_shadows.networks.object_space.occupancy_field_network import LIMIT
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.reports.drawing import hero_view
from neural_shadows.reports.drawing.mesh_slice import slice_mesh
from neural_shadows.reports.figures import (
    errors_3d,
    field_3d,
    field_slice,
)

FIELD = {"encoding": "occupancy_field", "resolution": 32, "surface": "solid", "stored": "float32"}
RADIUS = 0.7


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A ball, its exact field and references."""
    folder = tmp_path_factory.mktemp("ball")
    ball = trimesh.creation.icosphere(4, radius=RADIUS)
    ball.export(folder / "mesh.ply")
    field = make_network(FIELD)
    field.prepare(folder / "mesh.ply")
    corner = 4 * np.argwhere(field.grid.view(8, 8, 8).numpy() >= 0)
    vertices = (corner[:, None] + np.indices((5, 5, 5)).reshape(3, -1).T) / 16 - 1
    with torch.no_grad():
        inside = torch.from_numpy(RADIUS - np.linalg.norm(vertices, axis=-1)).float()
        field.values[field.table.long()] = 20 * inside.flatten()
    (folder / "field").mkdir()
    save_network(folder / "field" / "weights.safetensors", field, {"network": FIELD})
    scene = scene_of(ball)
    frame = render_gbuffer(scene, hero_view.hero_view(Y_UP), 60, 40)
    references = [(frame, exact_visibility(scene.tracer, frame))] * 2
    write_references(folder / "000.safetensors", references, scene.ground)
    return folder


def test_the_slice_of_a_ball_is_held_at_its_surface_and_enclosed_inside(files):
    cut = slice_mesh(scene_of(trimesh.load(files / "mesh.ply")))
    field, _ = load_network(files / "field" / "weights.safetensors")
    logits = field_slice.slice_logits(field, cut, np.zeros(2), 1.0)
    axis = (np.arange(len(logits)) + 0.5) / len(logits) * 2 - 1
    inside = RADIUS - np.hypot(*np.meshgrid(axis, axis))
    near = (inside > 0.005) & (inside < 0.02)
    np.testing.assert_allclose(logits[near], 20 * inside[near], atol=0.1)
    assert np.isnan(logits[inside < -0.5]).all() and (logits[inside > 0.6] > LIMIT).all()


def test_wrong_points_are_where_the_visibility_differs(files):
    batch = References(files / "000.safetensors")
    frame, truth = next(iter(batch))
    assert errors_3d.wrong_points(lambda frame: lambda bias: truth, 0.0, batch)[2] == 0
    dark = errors_3d.wrong_points(lambda frame: lambda bias: bias * truth, 0.0, batch)
    _, sign, share = dark
    assert share == pytest.approx(truth.sum() / len(frame.lit_side))
    np.testing.assert_array_equal(np.unique(sign), [-1])


def test_the_learned_surface_of_a_ball_is_a_ball(files):
    field, _ = load_network(files / "field" / "weights.safetensors")
    points = field_3d.learned_surface(field).points
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), RADIUS, atol=2e-3)


def test_the_detail_of_a_slice_is_where_the_surface_is_stored():
    logits = np.full((field_slice.PIXELS, field_slice.PIXELS), np.nan)
    logits[100:300, 100:300] = 5  # inside alone
    logits[600:700, 450:500], logits[600:700, 500:550] = 5, -5
    x, y = field_slice.choose_detail(logits)
    assert (x, y) == pytest.approx((2 * 500 / 900 - 1, 2 * 650 / 900 - 1), abs=0.06)
