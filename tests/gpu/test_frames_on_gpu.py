"""Screen-space networks: a GPU's answers and trainings beside those of a CPU."""

import json
from copy import deepcopy
from pathlib import Path

import pytest
import torch
from built_networks import make_screen_network
from screen_frames import FEATURES, TRAINING, write_frames

from neural_shadows.evaluation.profile_screen_network import PRECISIONS, profile_screen_network
from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.compute import is_native
from neural_shadows.running.stage import converted
from neural_shadows.training.train_on_frames import train_on_frames

GPU = torch.device("cuda")
WIDTHS = [8, 16, 32]
FORMS = {
    form: {"form": form, "widths": WIDTHS, "features": FEATURES}
    for form in ("shuffle", "half", "original", "direct")
}
FORMS["kernels"] = {"form": "kernels", "widths": WIDTHS, "filters": 2}
FORMS["kernels"] |= {"features": ["cosine", "penumbra", "z_b", "base_hard"]}
EACH_FORM = pytest.mark.parametrize("settings", FORMS.values(), ids=FORMS)
LONGER = TRAINING | {"optimiser": "muon", "adam_rate": 3e-3, "steps": 60, "crops": 4, "crop": 32}


def train(folder: Path, part: Path, **changes) -> dict:
    """Train a network in `folder`; gives what its record says."""
    results = folder / "nsm"
    arguments = {
        "train": [part],
        "validation": [part],
        "trunk": None,
        "weights": results / "weights.safetensors",
        "loss_csv": results / "loss.csv",
        "training_json": results / "training.json",
        "training": LONGER,
        "scenes": ["wall"],
        "lights": None,
        "seed": 1,
        "experiment": "nsm",
        "precision": "float32",
        "threads": 1,
    }
    train_on_frames(**converted(train_on_frames, arguments | changes))
    return json.loads((results / "training.json").read_text())


@EACH_FORM
def test_answers_are_those_of_the_cpu(settings):
    network = make_screen_network(settings).for_inference()
    generator = torch.Generator().manual_seed(2)
    x = torch.rand(1, channels_of(settings["features"]), 96, 128, generator=generator)
    with torch.inference_mode():
        expected = network.in_bands(x)
        for dtype, tolerance in ((torch.float32, 3e-3), (torch.bfloat16, 0.05)):
            if is_native(dtype, GPU):
                there = deepcopy(network).to(GPU, dtype, memory_format=torch.channels_last)
                planes = x.to(GPU, dtype, memory_format=torch.channels_last)
                unlike = (there.in_bands(planes).float().cpu() - expected).abs().max()
                assert unlike < tolerance * max(1, expected.abs().max()), dtype


@EACH_FORM
@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_a_training_ends_where_the_cpu_s_does(tmp_path, settings, precision):
    if not is_native(getattr(torch, precision), GPU):
        pytest.skip(f"this GPU has no {precision}")
    part = write_frames(tmp_path, count=3)
    training = LONGER | {"aligned": settings["form"] == "kernels"}
    how = {"network": settings, "training": training}
    gpu = train(tmp_path / "gpu", part, **how, device="cuda", precision=precision)
    cpu = train(tmp_path / "cpu", part, **how, device="cpu")
    assert gpu["training"]["device"] == "cuda" and gpu["died_at_step"] is None
    assert gpu["final_loss"] == pytest.approx(cpu["final_loss"], rel=0.2)
    assert gpu["validation_mse"] == pytest.approx(cpu["validation_mse"], rel=0.5, abs=2e-3)
    assert gpu["null_mse"]["no_shadow"] == pytest.approx(cpu["null_mse"]["no_shadow"], rel=1e-4)


def test_a_profile_has_the_gpus_runs(tmp_path):
    profile = {"width": 256, "height": 128, "repeats": 3, "product_size": 512}
    arguments = {"network": FORMS["shuffle"], "profile": profile, "device": "cuda", "threads": 2}
    path = tmp_path / "profile.json"
    profile_screen_network(path, **converted(profile_screen_network, arguments))
    runs = json.loads(path.read_text())["runs"]
    on_gpu = [run["precision"] for run in runs if run["device"] == "cuda"]
    native = [dtype for dtype in PRECISIONS if is_native(dtype, GPU)]
    assert on_gpu == [str(dtype).removeprefix("torch.") for dtype in native]
