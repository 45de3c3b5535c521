import numpy as np
import pytest
from evaluated import SCENE, make_evaluated

from neural_shadows.evaluation.evaluate import evaluate
from neural_shadows.evaluation.first_frames import read_first_frames
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.shadow_methods import open_network, traced_method
from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.psnr_ssim import psnr
from neural_shadows.networks.object_space.shadow_query import network_lit, on_device
from neural_shadows.rendering.shading import shade
from neural_shadows.scenes.scene import open_scene


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return make_evaluated(tmp_path_factory.mktemp("evaluated"))


def evaluated(files, folder, method, weights=None, **settings):
    """Metrics by view set, view and metric; and the paths of metrics and pictures."""
    metrics_csv, pictures_npz = folder / f"{method}.000.csv", folder / f"{method}.000.npz"
    evaluate(
        files.references,
        files.mesh_ply,
        weights,
        settings.pop("depth_bias_json", None),
        files.lpips_json,
        metrics_csv,
        pictures_npz,
        method=method,
        scene=SCENE,
        **settings,
    )
    metrics = read_metrics([metrics_csv])
    assert set(metrics["method"]) == {method}
    values = metrics.set_index(["view_set", "view", "metric"])["value"]
    return values, metrics_csv, pictures_npz


def test_metrics_are_those_of_each_view(files, tmp_path):
    values, metrics_csv, pictures_npz = evaluated(files, tmp_path, "shadow_map_64")
    answer = traced_method("shadow_map_64", open_scene(files.mesh_ply, **SCENE))
    for frame, truth in References(files.references):
        view = (frame.view.view_set, frame.view.index)
        visibility = answer(frame)
        image, reference = shade(frame, visibility), shade(frame, truth)
        assert values[*view, "psnr"] == psnr(image, reference) < 100
        wrong = np.mean(visibility != truth)
        assert values[*view, "shadow_error"] == pytest.approx(wrong)
        parts = values[*view, "false_shadow"] + values[*view, "light_leak"]
        assert parts == pytest.approx(wrong)
        assert 0 < values[*view, "flip"] < 1 and 0 < values[*view, "ssim"] < 1
    assert len(values) == 4 * 6  # without LPIPS

    first = read_first_frames([files.pictures_npz, pictures_npz], [metrics_csv])
    assert [frame.caption.split()[0] for frame in first] == ["aimed", "aimed"]
    for frame, (pixels, truth) in zip(first, list(References(files.references))[::2]):
        assert list(frame.images) == ["reference", "shadow_map_64"]
        expected = np.round(255 * shade(pixels, truth)).astype(np.uint8)
        np.testing.assert_array_equal(frame.images["reference"], expected)
        key = (pixels.view.view_set, 0)
        assert frame.scores["shadow_map_64"]["psnr"] == values[*key, "psnr"]


def test_a_network_is_asked_with_its_bias(files, tmp_path):
    write_json(tmp_path / "net.json", {"depth_bias": 0.3})
    network, dtype = open_network(files.weights, "cpu", 1)
    runs = {0.0: {"bias": 0.0}, 0.3: {"bias": 0.3}}
    runs[0.3, "found"] = {"bias": "held_out", "depth_bias_json": tmp_path / "net.json"}
    errors = {}
    for key, settings in runs.items():
        values, _, _ = evaluated(files, tmp_path, "net", files.weights, device="cpu", **settings)
        errors[key] = values["surface", 0, "shadow_error"]
    frame, truth = next(
        one for one in References(files.references) if one[0].view.view_set == "surface"
    )
    p, light = on_device(frame.p, frame.view.light, network.device)
    for bias in (0.0, 0.3):
        lit = network_lit(network, p, light, dtype=dtype, depth_bias=bias).numpy()
        assert errors[bias] == pytest.approx(np.mean(frame.visibility(lit) != truth))
    assert errors[0.0] != errors[0.3] == errors[0.3, "found"]
