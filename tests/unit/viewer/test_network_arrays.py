"""What the shaders are given is what the networks hold; the browser's tests ask them."""

import numpy as np
import pytest
from built_networks import make_network
from shapes import bumpy_sphere
from viewer_page import unpacked

from neural_shadows.representations.distance_bricks.distances_around import distances_around
from neural_shadows.representations.distance_bricks.field_marching import SOLID
from neural_shadows.representations.shadow_field.grid_codes import SOLID_CODE
from neural_shadows.viewer.network_arrays import network_arrays


@pytest.mark.parametrize("width", [64, 18])
def test_frequency_network_in_blocks(width):
    """A column of a block gives four outputs what one input is worth, as network.glsl adds them."""
    network = make_network(
        {"encoding": "frequency", "frequencies": 3, "width": width, "hidden_layers": 1}
    )
    network.initialise(1)
    found = network_arrays(network, trained=False)
    blocks = unpacked(found["arrays"]["weights"]).view(np.float16).astype(np.float32)
    x = np.random.default_rng(0).normal(size=6 * (1 + 2 * 3)).astype(np.float32)
    h, first = np.pad(x, (0, -len(x) % 4)), 0
    for _ in range(2):
        outputs = found["width"]
        layer = blocks[first : first + outputs * len(h)].reshape(outputs // 4, -1, 4)
        first += outputs * len(h)
        h = np.maximum(np.einsum("jkc,k->jc", layer, h).ravel(), 0)
    expected = x
    for weight in network.layers:
        expected = np.maximum(weight.detach().numpy() @ expected, 0)
    assert np.allclose(h[:width], expected, atol=5e-3) and not h[width:].any()
    assert blocks[first:] @ h == pytest.approx(
        float(network.output.detach().numpy()[0] @ expected), abs=5e-3
    )


def test_field_of_bricks(tmp_path):
    bumpy_sphere(4).export(tmp_path / "mesh.ply")
    settings = {"encoding": "occupancy_field", "resolution": 32, "stored": "int8"}
    network = make_network(settings | {"surface": "solid", "start": "distances"})
    network.prepare(tmp_path / "mesh.ply")
    network.initialise(0)
    network.push = 0.05
    found = network_arrays(network, trained=False)
    grid, codes = network.grid.numpy(), unpacked(found["arrays"]["grid"])
    assert found["bricks"] == 8 and len(codes) == 8**3
    assert np.array_equal(codes == 0, grid >= 0) and (grid >= 0).any()
    assert np.array_equal(codes == SOLID_CODE, grid == SOLID) and (grid == SOLID).any()
    empty = (codes > 0) & (codes < SOLID_CODE)
    assert np.array_equal(-codes[empty].astype(int), grid[empty])
    values = unpacked(found["arrays"]["values"])
    shares = network.shares().detach().numpy()
    assert np.abs(values * np.abs(shares).max() / 127 - shares).max() < 0.005
    # A solid's distances, for cones: those around it, in steps, from differences along three axes.
    size = found["bricks"] + 1
    zigzags = unpacked(found["arrays"]["around"]).astype(int).reshape(size, size, size)
    steps = np.where(zigzags & 1, -(zigzags + 1) // 2, zigzags // 2)
    for axis in range(3):
        steps = steps.cumsum(axis)
    bricks, scale = network._brick_values()
    around = distances_around(network.grid.view(8, 8, 8).numpy(), bricks)
    assert np.abs(steps * found["step"] - around).max() <= found["step"] / 2 + 1e-6
    assert found["unit"] == pytest.approx(scale / 0.45 * 2 / 32) and found["push"] == 0.05
    # Pushed out by a twentieth of a cell: a level below zero, in the values' steps.
    assert found["level"] == pytest.approx(-0.05 * 0.45 / np.abs(shares).max() * 127, rel=0.01)


@pytest.mark.parametrize("changes, trained", [({}, True), ({"start": "undecided"}, False)])
def test_values_that_are_no_distances_are_for_rays_alone(tmp_path, changes, trained):
    bumpy_sphere(3).export(tmp_path / "mesh.ply")
    settings = {"encoding": "occupancy_field", "resolution": 32, "stored": "int8"}
    network = make_network(settings | {"surface": "solid", "start": "distances"} | changes)
    network.prepare(tmp_path / "mesh.ply")
    network.initialise(0)
    assert set(network_arrays(network, trained)["arrays"]) == {"grid", "values"}


def test_kind_without_a_shader():
    settings = {"encoding": "ray_grid", "points": 2, "grids": [4], "channels": 1, "width": 8}
    network = make_network(
        settings | {"hidden_layers": 1, "head": "depth_confidence", "stored": "float16"}
    )
    with pytest.raises(TypeError, match="RayGrid"):
        network_arrays(network, trained=False)
