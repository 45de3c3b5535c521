"""A network of whole frames as a method for soft shadows."""

import json
from unittest import mock

import numpy as np
import pytest
import torch
from built_networks import make_screen_network
from opened import evaluate_frames, frame_method
from rendered_frames import render_part
from scipy.ndimage import maximum_filter, minimum_filter

from neural_shadows.errors import InputError
from neural_shadows.evaluation import screen_network_method
from neural_shadows.evaluation.answers import flicker_name, read_answer
from neural_shadows.evaluation.frame import Inputs
from neural_shadows.evaluation.measure_frames import measure_frames
from neural_shadows.evaluation.measure_sensitivity import measure_sensitivity
from neural_shadows.evaluation.measured_frames import measured_frames, open_methods
from neural_shadows.evaluation.method import visibility
from neural_shadows.evaluation.metric_files import read_metrics
from neural_shadows.evaluation.registry import is_network
from neural_shadows.evaluation.time_methods import time_methods
from neural_shadows.frames.buffers import LIT
from neural_shadows.frames.feature_names import NSM_FEATURES
from neural_shadows.frames.ray_tracing import traced_images
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.networks import compute
from neural_shadows.networks.screen_space.screen_networks import save_screen_network
from neural_shadows.training.screen_batches import ScreenFrames

RADII = [0, 0.125, 0.25]
NETWORK = {"form": "shuffle", "widths": [8, 8]}
NETWORK |= {"features": ["c_e", "view", "ratio", "difference"]}


def small_answers():
    """An untrained network whose answers stay within 0 and 1."""
    network = make_screen_network(NETWORK)
    network.initialise(1)
    *_, last = (one for one in network.modules() if hasattr(one, "in_channels"))
    last.weight.data *= 0.02
    return network


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    for use in ("test", "light"):
        frames = {"height": 32, "radii": RADII}
        render_part(folder / "blinds", use, frames, last=3, samples=4)
    (folder / "lpips.json").write_text(json.dumps({"available": False}))
    (folder / "tiny").mkdir()
    header = {"network": NETWORK, "training": {}, "radii": RADII, "radius_unit": "metres"}
    network = small_answers()
    save_screen_network(folder / "tiny/weights.safetensors", network, header)
    return folder


def test_it_filters_the_rays_of_a_frame(folder):
    """Of their own number, with neither map nor stored buffers: within what a kernel reaches."""
    settings = {"form": "kernels", "widths": [8, 8], "filters": 1, "edge": 0.1}
    settings |= {"features": ["cosine", "ray_penumbra", "log_d", "base_rays"]}
    network = make_screen_network(settings)
    network.initialise(1)
    header = {"network": settings, "training": {}, "radii": RADII, "radius_unit": "metres"}
    save_screen_network(folder / "rays.safetensors", network, header | {"rays": 2})
    method = frame_method("rays", folder / "rays.safetensors")
    measured = next(measured_frames([folder / "blinds/test_000.json"], []))
    with mock.patch.object(SoftFrame, "depths", property(lambda frame: pytest.fail("a map"))):
        visible = measured.answered(method, 0.25, {})
    rays, _ = traced_images(measured.frame, 0.25, samples=2)
    assert np.all(visible <= maximum_filter(rays, 5) + 1e-5)
    assert np.all(visible >= minimum_filter(rays, 5) - 1e-5)
    assert 0.001 < np.abs(visible - rays)[measured.valid].mean() < 0.5


def test_one_network_by_scene_answers_no_scene_that_it_has_not_learned(folder):
    weights = folder / "learned.safetensors"
    header = {"network": NETWORK, "training": {}, "radii": RADII, "scenes": ["atrium"]}
    save_screen_network(weights, small_answers(), header | {"radius_unit": "metres"})
    assert open_methods("tiny", Inputs([], weights=[weights]))("hall") is not None
    of_scene = open_methods("tiny", Inputs([], weights=[weights], by_scene=True))
    assert of_scene("atrium") is not None and of_scene("hall") is None


@pytest.mark.usefixtures("any_format")
def test_it_answers_in_the_number_format_that_is_asked_for(folder):
    """Which of bfloat16 is seen in its answers: eight bits of a number near 1."""
    weights = folder / "tiny/weights.safetensors"
    frame = next(measured_frames([folder / "blinds/test_000.json"], []))
    exact, rounded = (
        frame.answered(frame_method("tiny", weights, precision), 0.25, {})
        for precision in ("float32", "bfloat16")
    )
    inside = (exact > 0) & (exact < 1) & frame.valid
    assert 0 < np.median(np.abs(exact - rounded)[inside]) < 0.02
    assert len(np.unique(rounded[inside])) < len(np.unique(exact[inside]))


KERNELS = {"form": "kernels", "widths": [4, 8], "filters": 2}
OF_KERNELS = ["cosine", "c_v_by_d", "penumbra", "behind", "z_b", "z_b_by_z"]
FORMS = {"nsm": NETWORK | {"features": [*NSM_FEATURES]}}
FORMS |= {base: KERNELS | {"features": [*OF_KERNELS, f"base_{base}"]} for base in LIT}


@pytest.mark.parametrize("form", FORMS)
def test_what_is_timed_is_what_is_evaluated(folder, tmp_path, form):
    """Of rounded buffers and a traced map, but for the order of sums."""
    network = make_screen_network(FORMS[form])
    network.initialise(1)
    path = tmp_path / "weights.safetensors"
    header = {"network": FORMS[form], "radii": RADII, "radius_unit": "metres"}
    save_screen_network(path, network, header)
    method = frame_method("tiny", path, "float32")
    measured = next(measured_frames([folder / "blinds/test_000.json"], []))
    asked = measured.answered(method, 0.25, {})
    assert asked.min() >= 0 and asked.max() <= 1
    assert not np.allclose(asked, measured.answered(method, 0, {}))  # it knows the light's size
    frame = measured.frame
    vars(frame)["depths"] = frame.light_map.depths(frame.scene.tracer)
    exact = frame.surface.image(visibility(method, frame, 0.25, {}), 1.0)
    off = np.abs(exact - asked)
    # A rounding moves a kernel's weights by a hundredth, no more.
    assert np.median(off) < 1e-3 and np.quantile(off, 0.99) < 0.02
    made = screen_network_method.channel_images
    halved = mock.Mock(
        side_effect=lambda *of: {k: np.float32(np.float16(one)) for k, one in made(*of).items()}
    )
    with mock.patch.object(screen_network_method, "channel_images", halved):
        rounded = frame.surface.image(visibility(method, frame, 0.25, {}), 1.0)
    assert np.allclose(rounded, asked, atol=1e-5)


def test_it_is_measured_as_others_are(folder):
    assert is_network("tiny")
    out = folder / "tiny.csv", folder / "tiny.npz"
    parts = [folder / "blinds/test_000.json"], [folder / "blinds/light_000.json"]
    weights = folder / "tiny/weights.safetensors"
    occluders = folder / "occluders.npy"
    measure_frames(parts[0], [], occluders, measure="occluders.npy")
    told = {"sequences": parts[1], "weights": [weights], "occluders": occluders}
    evaluate_frames(parts[0], folder / "lpips.json", out, **told, method="tiny")
    table = read_metrics(out[:1])
    assert len(table[table["metric"] == "mse"]) == 3 * len(RADII)
    means = table.groupby("metric")["value"].mean()
    # What lies behind slats of which a way crosses one or more, but seldom many.
    solids, widths = np.moveaxis(np.load(occluders), 1, 0)
    assert set(np.unique(solids)) >= {0, 1} and 0 < means["mse_behind"] and 0 < means["mse_widest"]
    assert 0 < widths.max() < 48 and 1 <= means["solids_behind"] < 2
    # Averaged with the frame before, it changes less.
    assert means["instability_taa"] < means["instability"]
    maps = [read_answer(out[1], flicker_name(parts[1][0], exact)) for exact in (False, True)]
    assert maps[0].shape == (32, 48) and not np.allclose(*maps)


def test_of_several_networks_each_answers_the_scene_that_it_learned(folder, tmp_path):
    """A scene that none has learned has no answers."""
    weights = []
    for scenes, seed in ((["atrium", "blinds"], 2), (["hall"], 3)):
        network = small_answers()
        network.initialise(seed)
        weights.append(tmp_path / f"{scenes[0]}/weights.safetensors")
        weights[-1].parent.mkdir()
        header = {"network": NETWORK, "scenes": scenes, "radii": RADII, "radius_unit": "metres"}
        save_screen_network(weights[-1], network, header)
    found = []
    for files in (weights, weights[:1], weights[1:] * 2):
        out = tmp_path / "one.csv", tmp_path / "one.npz"
        lpips = folder / "lpips.json"
        parts = [folder / "blinds/test_000.json"]
        evaluate_frames(parts, lpips, out, weights=files, method="of_scenes", by_scene=True)
        found.append(out[0].read_text())
    assert found[0] == found[1] and found[2].count("\n") == 1  # the headings alone


def test_in_a_format_that_the_processor_lacks_it_has_no_answers(folder, tmp_path, monkeypatch):
    for module in (compute, screen_network_method):
        monkeypatch.setattr(module, "is_native", lambda dtype, device: dtype == torch.float32)
    weights, lpips = [folder / "tiny/weights.safetensors"], folder / "lpips.json"
    parts, lines = [folder / "blinds/test_000.json"], {}
    for precision in ("auto", "float32", "bfloat16"):
        out = tmp_path / "one.csv", tmp_path / "one.npz"
        evaluate_frames(parts, lpips, out, weights=weights, method="tiny", precision=precision)
        lines[precision] = out[0].read_text()
    assert lines["auto"] == lines["float32"]
    assert lines["float32"].count("\n") > 1 and lines["bfloat16"].count("\n") == 1


def test_times(folder):
    out = folder / "times.json"
    weights = [folder / "tiny/weights.safetensors"]
    parts = [folder / "blinds/test_000.json"]
    methods = {"no_shadow": None, "of_scenes": "tiny"}  # one of several networks is timed for all
    time_methods(parts, [], [], weights, [], out, methods=methods, repeats=1)
    found = json.loads(out.read_text())["methods"]["of_scenes"]
    assert all(ms > 0 for ms in found["ms"])
    count = sum(one.numel() for one in make_screen_network(NETWORK).parameters())
    size = compute.choose_dtype("auto", torch.device("cpu")).itemsize
    assert found["held_bytes"] == size * count and found["texel_floats"] == 1


def test_a_larger_light_than_it_knows_is_refused(folder):
    method = frame_method("tiny", folder / "tiny/weights.safetensors")
    frame = next(measured_frames([folder / "blinds/test_000.json"], []))
    with pytest.raises(InputError, match=r"up to 0.25 metres, and these frames have one of 0.3"):
        frame.answered(method, 0.3, {})


@pytest.mark.parametrize(
    "light",
    [
        {"light": {"shape": "rectangle", "aspect": 0.25}},
        {"light": {"shape": "sun"}, "radius_unit": "degrees", "radii": [0, 1, 3]},
    ],
)
def test_it_is_evaluated_on_the_features_of_its_training(tmp_path, light):
    """For lights whose radii are not as they are configured."""
    part = render_part(tmp_path / "blinds", "test", {"height": 32, "radii": RADII} | light)
    settings = FORMS["pcf"]
    network = make_screen_network(settings)
    network.initialise(1)
    frames = ScreenFrames([part], network.features)
    header = {key: frames.about[key] for key in ("radius_unit", "light")}
    header |= {"network": settings, "radii": frames.about["given_radii"]}
    weights = tmp_path / "weights.safetensors"
    save_screen_network(weights, network, header)
    method = frame_method("tiny", weights, "float32")
    measured = next(measured_frames([part], []))
    for k, radius in enumerate(measured.part.radii):
        with torch.inference_mode():
            planes = torch.from_numpy(frames.features(0, k))[None]
            expected = network.for_inference()(planes)[0, 0].clamp(0, 1).numpy()
        seen = measured.picture("z") > 0
        visible = measured.answered(method, radius, {})
        assert np.allclose(visible[seen], expected[seen], atol=1e-5)


def test_features_that_the_answer_does_not_hang_on_have_no_share(folder):
    network = small_answers()
    first = next(one for one in network.modules() if getattr(one, "in_channels", 0) == 16)
    # Of 2 × 2 pixels each, the features one after another.
    first.weight.data[:, 4:8] = 0  # view
    path = folder / "blind/weights.safetensors"
    path.parent.mkdir()
    save_screen_network(
        path, network, {"network": NETWORK, "training": {}, "radii": RADII, "radius_unit": "metres"}
    )
    out = folder / "sensitivity.json"
    measure_sensitivity([folder / "blinds/test_000.json"], path, out, seed=1, frames=2, repeats=1)
    found = json.loads(out.read_text())["features"]
    assert found["view"]["share"] == 0
    assert sum(one["share"] for one in found.values()) == pytest.approx(1)
    assert all(found[name]["share"] > 0 for name in ("c_e", "ratio", "difference"))
