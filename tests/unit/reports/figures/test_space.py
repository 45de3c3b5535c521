"""Figures in 3D and of fields."""

from contextlib import suppress

import numpy as np
import pytest
import torch
import trimesh
from built_networks import make_network
from matplotlib.image import imread
from report_samples import constants_of, written_figure
from shapes import SPHERE_OF_LIGHTS, Y_UP, scene_of

from neural_shadows.evaluation.references import References, write_references
from neural_shadows.files.whole_files import write_json
from neural_shadows.networks.object_space.occupancy_field_network import LIMIT
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.rays.labels import dual_bounds
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.reports.drawing import hero_view, opengl
from neural_shadows.reports.drawing.mesh_slice import slice_mesh
from neural_shadows.reports.drawing.style import write_figure
from neural_shadows.reports.figures import (
    depth_sheets_3d,
    errors_3d,
    field_3d,
    field_slice,
    scene_3d,
)

with suppress(ImportError):  # after a driver's LLVM it would crash, and torchvision imports it
    import triton  # noqa: F401

SCENE = {"up": "y", "ground": True, "light": SPHERE_OF_LIGHTS}
FIELD = {"encoding": "occupancy_field", "resolution": 32, "surface": "solid", "stored": "float32"}
RADIUS = 0.7


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A ball, its exact field, references and rays."""
    folder = tmp_path_factory.mktemp("ball")
    ball = trimesh.creation.icosphere(4, radius=RADIUS)
    ball.export(folder / "mesh.ply")
    write_json(folder / "mesh.json", {"name": "ball"})
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
    directions = np.float32([[0, -1, 0], [1, 0, 0]])
    origins = np.float32([[[0, 1, 0], [0.6, 0.8, 0]], [[-1, 0, 0], [-0.8, 0, 0.6]]])
    along = np.repeat(directions, 2, axis=0)
    bounds = np.stack(dual_bounds(scene.tracer, origins.reshape(-1, 3), along), axis=1)
    np.save(folder / "directions.npy", directions)
    np.save(folder / "origins.000.npy", origins)
    np.save(folder / "bounds.000.npy", bounds.reshape(2, 2, 2))
    return folder


@pytest.mark.parametrize("kind", [field_slice, field_3d, depth_sheets_3d, scene_3d, errors_3d])
def test_each_kind_is_drawn(files, tmp_path, kind):
    if kind is not field_slice and not opengl.available():
        pytest.skip("no OpenGL")
    weights, bias_json = files / "field" / "weights.safetensors", tmp_path / "field.json"
    write_json(bias_json, constants_of(0.01, 0.0, False))
    arguments = {"mesh_ply": files / "mesh.ply", "scene": SCENE}
    if kind is scene_3d:
        arguments |= {"mesh_json": files / "mesh.json", "directions_npy": files / "directions.npy"}
        arguments |= {key: [files / f"{key}.000.npy"] for key in ("origins", "bounds")}
    elif kind is errors_3d:
        arguments |= {"references": files / "000.safetensors"}
        arguments |= {"weights": [weights], "depth_biases": [bias_json]}
        map_ = {"method": "shadow_map_16", "label": "a map", "experiment": None, "bias": None}
        field = {"method": "field", "label": "a field", "experiment": "field", "bias": "held_out"}
        arguments["rows"] = [map_, field]
    else:
        arguments["weights"] = weights
    svg = written_figure(kind.draw, tmp_path, write_figure, **arguments)
    assert imread(tmp_path / "figure.png")[..., :3].std() > 0.04
    assert len(svg) < 1_500_000


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
