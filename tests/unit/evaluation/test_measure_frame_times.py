import json

import numpy as np
import pytest
import torch
import trimesh
from shapes import bumpy_sphere, looking, prepared, unit

from neural_shadows.evaluation import measure_frame_times as frame_times
from neural_shadows.evaluation.measure_frame_times import measure_frame_times, shadow_times
from neural_shadows.evaluation.shadow_methods import StopwatchNetwork, shadow_passes
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.shadow_query import network_lit, on_device
from neural_shadows.networks.weight_file import save_network
from neural_shadows.rendering.gbuffer import primary_hits
from neural_shadows.rendering.shading import reference_visibility
from neural_shadows.shadow_maps.shadow_map import receivers_of, shadow_map_frame, shadow_map_lit

KIND = {"encoding": "frequency"}
TINY = {"frequencies": 2, "width": 16, "hidden_layers": 1}


@pytest.fixture(scope="module")
def frame():
    mesh, tracer = prepared(bumpy_sphere(4))
    points = primary_hits(mesh, tracer, looking((0, 1, 3), unit(1, 1, 0.3)), 150, 100, -1.0)
    return mesh, tracer, points


def test_passes_answer_as_the_evaluation_does(frame):
    mesh, tracer, points = frame
    network = FrequencyNetwork(**TINY)
    network.initialise(1)
    passes = shadow_passes(
        mesh, tracer, {"net": StopwatchNetwork(network)}, [64, 200], torch.float32
    )
    assert list(passes) == ["ray_traced", "shadow_map_64", "shadow_map_200", "net"]
    answers = {name: lit_of(points) for name, lit_of in passes.items()}
    receivers = receivers_of(shadow_map_frame(mesh.vertices, points.light), points)
    np.testing.assert_array_equal(answers["ray_traced"], reference_visibility(tracer, points))
    for resolution in (64, 200):
        # The whole map against the one that is traced only where it is looked up.
        lazy = shadow_map_lit(tracer, receivers, resolution)
        np.testing.assert_array_equal(answers[f"shadow_map_{resolution}"], lazy)
    p, light = on_device(points.p, points.light, torch.device("cpu"))
    expected = network_lit(network, p, light, dtype=torch.float32)
    np.testing.assert_array_equal(answers["net"], expected.numpy())
    assert 0 < answers["ray_traced"].mean() < 1


def test_times_are_milliseconds_of_each_pass(frame, monkeypatch):
    _, _, points = frame
    clock = [0.0]
    monkeypatch.setattr(frame_times.time, "perf_counter", lambda: clock[0])

    def taking(seconds):
        def lit_of(points):
            clock[0] += seconds
            return np.ones(len(points.p), bool)

        return lit_of

    times = shadow_times({"a": taking(0.25), "b": taking(1.5)}, points)
    assert times == {"a": pytest.approx(250), "b": pytest.approx(1500)}


def test_file_of_times_names_methods_views_and_machine(tmp_path):
    shape = trimesh.creation.icosphere(3)
    shape.export(tmp_path / "mesh.ply")
    network = FrequencyNetwork(**TINY)
    network.initialise(1)
    save_network(tmp_path / "net.safetensors", network, {"network": KIND | TINY})
    measure_frame_times(
        tmp_path / "mesh.ply",
        {"net": tmp_path / "net.safetensors"},
        tmp_path / "times.json",
        scene_name="ball",
        shadow_maps=[32],
        view_sets=["shadow", "surface"],
        frames={
            "up": "y",
            "ground": True,
            "light": {"domain": "sphere", "min_elevation_deg": 20},
            "width": 96,
            "height": 64,
            "seed": 3,
        },
        repeats=5,
        warm_up=2,
        device="cpu",
    )
    times = json.loads((tmp_path / "times.json").read_text())
    assert list(times["methods"]) == ["ray_traced", "shadow_map_32", "net"]
    for values in times["methods"].values():
        assert len(values["ms"]) == 5
        assert min(values["ms"]) > 0
    assert times["views"] == 5
    assert times["device"] == "cpu"
    assert 0 < times["sphere_rays"] <= 96 * 64
    assert times["machine"]["cpu"]
