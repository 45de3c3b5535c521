"""What the benchmarks print is right; how fast anything is they measure and no test asserts."""

import numpy as np
import pytest
import torch
from frame_query import FrameQuery
from measurement import COLUMNS, Row, median_seconds, table
from shapes import bumpy_sphere, looking, scene_of, unit

from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.shadow_query import network_lit, on_device
from neural_shadows.rendering.gbuffer import render_gbuffer


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


def test_a_frame_from_its_depth_buffer_has_the_same_mask():
    """What a GPU is timed on, on the CPU: the points of the buffer, and the answers for them."""
    view = looking((0, 1, 3), unit(1, 1, 0.3))
    frame = render_gbuffer(scene_of(bumpy_sphere(4)), view, 150, 100)
    cpu = torch.device("cpu")
    query = FrameQuery(frame, cpu)
    pixel, p = query.points()
    order = np.argsort(frame.pixel[frame.lit_side])
    np.testing.assert_array_equal(pixel.numpy(), frame.pixel[frame.lit_side][order])
    # Each was moved off its surface by a thousandth, to any side of its pixel's centre.
    assert np.abs(p.numpy() - frame.p[order]).max() < 2e-3

    network = FrequencyNetwork(frequencies=2, width=16, hidden_layers=1)
    network.initialise(0)
    mask = query.mask(network, torch.float32)
    assert mask.shape == (100, 150)
    lit = network_lit(network, *on_device(frame.p, view.light, cpu), dtype=torch.float32)
    same = mask.flatten()[pixel] == lit[torch.from_numpy(order)]
    assert same.float().mean() > 0.99
    assert 0.1 < lit.float().mean() < 0.95
