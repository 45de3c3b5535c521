"""ONNX Runtime answers as PyTorch does, and the written conventions give the pipeline's shadow."""

import json
import math
from pathlib import Path

import numpy as np
import onnxruntime
import pytest
import torch
from built_networks import make_network
from opened import write_constants
from shapes import bumpy_sphere, looking, unit

from neural_shadows.errors import InputError
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import on_device
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.scenes.scene import open_scene
from neural_shadows.viewer import export_network as stage

GRID = {
    "points": 3,
    "grids": [5, 9],
    "channels": 2,
    "width": 16,
    "hidden_layers": 1,
    "head": "depth_confidence",
    "stored": "float16",
}
FIELD = {"encoding": "occupancy_field", "resolution": 32, "stored": "int8"}
KINDS = [
    {"encoding": "frequency", "frequencies": 4, "width": 16, "hidden_layers": 2},
    GRID | {"encoding": "hash_grid", "occupancy": 16, "table_size": 64},
    FIELD | {"surface": "solid"},
    FIELD | {"surface": "sheet"},
]


@pytest.fixture
def export(tmp_path):
    shape = bumpy_sphere(4)
    shape.export(tmp_path / "mesh.ply")
    (tmp_path / "mesh.json").write_text(json.dumps({"centre": [1, 2, 3], "radius": 4}))
    write_constants(tmp_path / "bias.json", depth_bias=0.02, push=0.1)

    def export(settings, biased=True):
        network = make_network(settings)
        if settings["encoding"] != "frequency":
            network.prepare(tmp_path / "mesh.ply")
        network.initialise(3)
        if settings["encoding"] == "occupancy_field" and "start" not in settings:
            network.values.data.normal_(generator=torch.Generator().manual_seed(0))
        if "head" in settings:
            network.output.bias.data = torch.tensor([0.8, 1.0])  # shadow, behind the front
        header = {"name": "net", "network": settings, "training": {"steps": 1}}
        save_network(tmp_path / "weights.safetensors", network, header)
        stage.export_network(
            weights=tmp_path / "weights.safetensors",
            mesh_json=tmp_path / "mesh.json",
            depth_bias_json=tmp_path / "bias.json" if biased else None,
            network_onnx=tmp_path / "network.onnx",
            network_json=tmp_path / "network.json",
            bias="held_out" if biased else 0.125,
        )
        return json.loads((tmp_path / "network.json").read_text())

    return export


@pytest.mark.parametrize("settings", KINDS, ids=lambda s: "-".join(map(str, s.values())))
def test_a_renderer_gets_the_pipeline_s_shadow(tmp_path, export, settings):
    """The query as network.json words it, with ONNX Runtime, against the test of depths."""
    biased = settings is not KINDS[0]
    conventions = export(settings, biased)
    assert conventions["query"]["depth_bias"] == (0.02 if biased else 0.125)
    network, _ = load_network(tmp_path / "weights.safetensors")
    network.push = 0.1 if biased else 0.0
    session = onnxruntime.InferenceSession(tmp_path / "network.onnx")
    scene = open_scene(tmp_path / "mesh.ply", up="y", ground=True, light={})
    frame = render_gbuffer(scene, looking((0, 1, 3), unit(1, 1, 0.3)), 90, 60)
    p, light = frame.p.astype(np.float64), frame.view.light

    along = p @ light
    across = p - along[:, None] * light
    inside = (across**2).sum(axis=1) < 1
    h = np.sqrt(np.maximum(1 - (across**2).sum(axis=1), 0))
    s = h - along
    asked = inside & (s > 0)
    origins = (across + h[:, None] * light)[asked].astype(np.float32)
    directions = np.tile(-light, (len(origins), 1)).astype(np.float32)
    (t_pred,) = session.run(None, {"origins": origins, "directions": directions})
    lit = np.ones(len(p), bool)
    bias = conventions["query"]["depth_bias"]
    lit[asked] = np.minimum(s[asked], 2 * h[asked]) <= t_pred + bias

    tensors = on_device(frame.p, frame.view.light, network.device)
    # A field on a CPU needs no depths: its samples lie elsewhere, which these random values show.
    expected = ShadowNetwork.points_lit(network, *tensors, torch.float32)(bias).numpy()
    assert 0 < (~expected).sum() < len(p)
    assert (lit == expected).mean() > 0.995  # rounding turns points on the border
    assert conventions["sphere"].items() >= {"centre": [1, 2, 3], "radius": 4}.items()
    assert conventions["network"] == settings
    assert conventions["onnx"]["difference_from_pytorch"] < 1e-4
    # It is given away: nothing in it is of this machine's folders.
    content = (tmp_path / "network.onnx").read_bytes()
    for folder in (Path(__file__).parents[3], Path(torch.__file__).parents[1], tmp_path):
        assert str(folder).encode() not in content


@pytest.mark.parametrize("difference", [0.1, math.nan])
def test_an_export_that_answers_otherwise_is_not_kept(tmp_path, export, monkeypatch, difference):
    monkeypatch.setattr(stage, "export_onnx", lambda network, path: path.write_text("other"))
    monkeypatch.setattr(stage, "largest_difference", lambda *_: difference)
    with pytest.raises(InputError, match=r"network\.onnx: ONNX Runtime's depths differ"):
        export(KINDS[0])
    assert not (tmp_path / "network.onnx").exists() and not (tmp_path / "network.json").exists()


def test_what_is_no_network_is_refused(tmp_path, export):
    with pytest.raises(InputError, match=r"weights\.safetensors: the encoding 'mesh' has no"):
        export({"encoding": "mesh", "triangles": None, "bits": 16})
    assert not (tmp_path / "network.onnx").exists()
