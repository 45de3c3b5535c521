"""What the benchmarks print is right; how fast anything is they measure and no test asserts."""

import numpy as np
import pytest
import torch
from frame_query import FrameQuery
from measurement import COLUMNS, Row, median_seconds, table
from shapes import bumpy_sphere

from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.shadow_query import network_lit, on_device
from neural_shadows.rendering.scene_frames import open_scene


def test_shares_and_ratios():
    rows = table(
        [
            Row("labels", "cpu", 3.0, "samples/s", ceiling=4.0, peer="trimesh", peer_rate=0.5),
            Row("rays", "cpu", 2.0, "samples/s"),
        ]
    )
    assert list(rows) == COLUMNS
    assert rows.iloc[0][["share", "ratio"]].tolist() == [0.75, 6.0]
    assert rows.iloc[1][["ceiling", "share", "peer", "ratio"]].isna().all()


def test_works_are_done_in_turn_and_the_first_round_does_not_count(monkeypatch):
    clock, done = [0.0], []
    monkeypatch.setattr("measurement.time.perf_counter", lambda: clock[0])

    def work(name, seconds):
        def do():
            done.append(name)
            clock[0] += seconds[len(done) // 2 - (name == "b")]

        return do

    found = median_seconds({"a": work("a", [9, 1, 2, 6]), "b": work("b", [9, 4, 3, 5])}, 3)
    assert done == ["a", "b"] * 4
    assert found == {"a": pytest.approx(2), "b": pytest.approx(4)}


def test_a_frame_from_its_depth_buffer_has_the_same_mask(tmp_path):
    """What a GPU is timed on, on the CPU: the points of the buffer, and the answers for them."""
    bumpy_sphere(4).export(tmp_path / "mesh.ply")
    light = {"domain": "sphere", "min_elevation_deg": 20}
    size = {"width": 150, "height": 100}
    scene = open_scene(tmp_path / "mesh.ply", up="y", ground=True, light=light, **size, seed=1)
    (view,) = scene.viewpoints(["surface"], [0])
    points = scene.points(view)
    cpu = torch.device("cpu")
    query = FrameQuery(scene, view, points, cpu)
    pixel, p = query.points()
    order = np.argsort(points.pixel[points.facing])
    np.testing.assert_array_equal(pixel.numpy(), points.pixel[points.facing][order])
    # Each was moved off its surface by a thousandth, to any side of its pixel's centre.
    assert np.abs(p.numpy() - points.p[order]).max() < 2e-3

    network = FrequencyNetwork(frequencies=2, width=16, hidden_layers=1)
    network.initialise(0)
    mask = query.mask(network, torch.float32)
    assert mask.shape == (100, 150)
    lit = network_lit(network, *on_device(points.p, points.light, cpu), dtype=torch.float32)
    same = mask.flatten()[pixel] == lit[torch.from_numpy(order)]
    assert same.float().mean() > 0.99
    assert 0.1 < lit.float().mean() < 0.95
