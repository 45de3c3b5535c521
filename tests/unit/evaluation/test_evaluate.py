import numpy as np
import pytest
from evaluated import SCENE, make_evaluated

from neural_shadows.evaluation.evaluate import evaluate
from neural_shadows.evaluation.first_frames import read_first_frames
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.shadow_methods import network_method, open_network, traced_method
from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.psnr_ssim import psnr
from neural_shadows.rendering.shading import shade
from neural_shadows.scenes.scene import open_scene


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return make_evaluated(tmp_path_factory.mktemp("evaluated"))


def evaluated(files, folder, method, weights=None, depth_bias_json=None, **settings):
    """Metrics by view set, view and metric; and the paths of metrics and pictures."""
    outputs = folder / f"{method}.000.csv", folder / f"{method}.000.npz"
    inputs = files.references, files.mesh_ply, weights, depth_bias_json, files.lpips_json
    evaluate(*inputs, *outputs, method=method, scene=SCENE, device="cpu", **settings)
    metrics = read_metrics(outputs[:1])
    return metrics.set_index(["view_set", "view", "metric"])["value"], *outputs


def test_metrics_are_those_of_each_view(files, tmp_path):
    values, metrics_csv, pictures_npz = evaluated(files, tmp_path, "shadow_map_64")
    answer = traced_method("shadow_map_64", open_scene(files.mesh_ply, **SCENE))
    for frame, truth in References(files.references):
        view = (frame.view.view_set, frame.view.index)
        visibility = answer(frame)
        image, reference = shade(frame, visibility), shade(frame, truth)
        assert values[*view, "psnr"] == psnr(image, reference) < 100
        assert values[*view, "shadow_error"] == pytest.approx(np.mean(visibility != truth))
        assert values[*view, "light_leak"] == pytest.approx(np.mean(visibility > truth))
        assert 0 < values[*view, "flip"] < 1 and 0 < values[*view, "ssim"] < 1
    assert len(values) == 4 * 6  # without LPIPS

    first = read_first_frames([files.pictures_npz, pictures_npz], [metrics_csv])
    for frame, (pixels, truth) in zip(first, list(References(files.references))[::2], strict=True):
        assert list(frame.images) == ["reference", "shadow_map_64"]
        expected = np.round(255 * shade(pixels, truth)).astype(np.uint8)
        np.testing.assert_array_equal(frame.images["reference"], expected)
        scores = frame.scores["shadow_map_64"]
        assert scores["psnr"] == values[pixels.view.view_set, 0, "psnr"]


def test_a_network_is_asked_with_its_bias(files, tmp_path):
    write_json(tmp_path / "net.json", {"depth_bias": 0.3})
    frame, truth = References(files.references)[2]
    errors = {}
    for bias in (0.0, 0.3):
        values, *_ = evaluated(files, tmp_path, "net", files.weights, bias=bias)
        errors[bias] = values["surface", 0, "shadow_error"]
        answer = network_method(*open_network(files.weights, "cpu", 1), bias)
        assert errors[bias] == pytest.approx(np.mean(answer(frame) != truth))
    found = {"bias": "held_out", "depth_bias_json": tmp_path / "net.json"}
    values, *_ = evaluated(files, tmp_path, "net", files.weights, **found)
    assert errors[0.0] != errors[0.3] == values["surface", 0, "shadow_error"]
