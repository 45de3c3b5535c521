import numpy as np
import pytest
from evaluated import SCENE, make_evaluated
from opened import evaluate_frames, write_constants

from neural_shadows.errors import InputError
from neural_shadows.evaluation.answers import read_view
from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.evaluation.ray_network import network_method, open_network
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.registry import classic_method
from neural_shadows.metrics.kinds.psnr import psnr
from neural_shadows.rendering.shading import shade
from neural_shadows.scenes.scene import open_scene


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return make_evaluated(tmp_path_factory.mktemp("evaluated"))


def evaluated(files, folder, method, constants_json=None, weights=None, **settings):
    """Metrics by view set, view and metric; and the paths of metrics and visibilities."""
    outputs = folder / f"{method}.csv", folder / f"{method}.npz"
    source = {"weights": [weights]} if weights else {"meshes": [files.mesh_ply]}
    settings |= source | {"constants": constants_json, "scene": SCENE}
    evaluate_frames([files.references], files.lpips_json, outputs, method=method, **settings)
    metrics = read_view_metrics(outputs[:1])
    return metrics.set_index(["view_set", "view", "metric"])["value"], *outputs


def test_metrics_are_those_of_each_view(files, tmp_path):
    values, _, visibilities_npz = evaluated(files, tmp_path, "shadow_map_64")
    answer = classic_method("shadow_map_64", open_scene(files.mesh_ply, **SCENE))
    for frame, truth in References(files.references):
        view = (frame.view.view_set, frame.view.index)
        visibility = answer(frame)(0.0)
        image, reference = shade(frame, visibility), shade(frame, truth)
        assert values[*view, "psnr"] == psnr(image, reference) < 100
        assert values[*view, "shadow_error"] == pytest.approx(np.mean(visibility != truth))
        assert values[*view, "light_leak"] == pytest.approx(np.mean(visibility > truth))
        assert 0 < values[*view, "flip"] < 1 and 0 < values[*view, "ssim"] < 1
    assert len(values) == 4 * 6  # without LPIPS


@pytest.mark.parametrize("method", ["shadow_map_64", "shadow_map_pcf_64"])
def test_every_frame_can_be_drawn_again(files, tmp_path, method):
    *_, visibilities_npz = evaluated(files, tmp_path, method)
    answer = classic_method(method, open_scene(files.mesh_ply, **SCENE))
    for number, (frame, _) in enumerate(References(files.references)):
        kept, given = read_view(visibilities_npz, number, frame), answer(frame)(0.0)
        assert (len(np.unique(given)) > 2) == ("pcf" in method)
        np.testing.assert_allclose(kept, given, rtol=0, atol=0.5 / 255 + 1e-6)
    with pytest.raises(InputError, match="damaged"):  # made of other views
        read_view(visibilities_npz, 0, frame)


def test_a_network_is_asked_with_its_bias(files, tmp_path):
    write_constants(tmp_path / "net.json", depth_bias=0.3, push=0.0)
    asked = {"weights": files.weights, "device": "cpu"}
    answer = network_method(*open_network(files.weights, "cpu", 1))
    batch = list(References(files.references))
    errors = {}
    for bias in (0.0, 0.3):
        values, *_ = evaluated(files, tmp_path, "net", **asked, bias=bias)
        errors[bias] = values[:, :, "shadow_error"].tolist()
        wrong = [np.mean(answer(frame)(bias) != truth) for frame, truth in batch]
        assert errors[bias] == pytest.approx(wrong)
    values, *_ = evaluated(files, tmp_path, "net", tmp_path / "net.json", **asked)
    assert errors[0.0] != errors[0.3] == values[:, :, "shadow_error"].tolist()


def test_a_map_has_the_bias_that_was_found_for_it(files, tmp_path):
    write_constants(tmp_path / "map.json", depth_bias=-0.05)
    errors = {}
    for method, file in {"shadow_map_64": None, "shadow_map_64_biased": "map.json"}.items():
        bias_json = file and tmp_path / file
        values, metrics_csv, _ = evaluated(files, tmp_path, method, bias_json)
        errors[method] = values["surface", 0, "false_shadow"]
        assert set(read_view_metrics([metrics_csv])["method"]) == {method}
    assert errors["shadow_map_64_biased"] > errors["shadow_map_64"] + 0.01


def test_answers_of_another_version_are_named(files, tmp_path):
    np.savez(tmp_path / "answers.npz", lit=np.ones(3))
    frame, _ = References(files.references)[0]
    with pytest.raises(InputError, match="answers.npz: damaged"):
        read_view(tmp_path / "answers.npz", 0, frame)
