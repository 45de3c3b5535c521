"""Screen-space networks: a GPU's answers and trainings beside those of a CPU."""

import json
from copy import deepcopy
from pathlib import Path

import pytest
import torch
from built_networks import make_screen_network
from screen_frames import write_frames

from neural_shadows.evaluation.profile_screen_network import profile_screen_network
from neural_shadows.frames.feature_names import channels_of
from neural_shadows.running.stage import converted
from neural_shadows.training.train_on_frames import train_on_frames

FOUR = ["c_e", "view", "ratio", "difference"]
FILTERED = ["cosine", "penumbra", "z_b", "base_hard"]
FORMS = {
    "shuffle": {"form": "shuffle", "widths": [8, 16, 32], "features": FOUR},
    "half": {"form": "half", "widths": [8, 16, 32], "features": FOUR},
    "original": {"form": "original", "widths": [8, 16, 32], "features": FOUR},
    "direct": {"form": "direct", "widths": [8, 16, 32], "features": FOUR},
    "kernels": {"form": "kernels", "widths": [8, 16, 32], "filters": 2, "features": FILTERED},
}
EACH_FORM = pytest.mark.parametrize("settings", FORMS.values(), ids=FORMS)
TRAINING = {
    "optimiser": "muon",
    "adam_rate": 3e-3,
    "steps": 60,
    "crops": 4,
    "crop": 32,
    "learning_rate": 5e-3,
    "schedule": "cosine",
    "alpha": 0.9,
    "perceptual": {"net": "none"},
    "perturbation": 3.0,
    "perturbation_from": 0.0,
    "aligned": False,
    "flips": True,
}


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
        "training": TRAINING,
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
            there = deepcopy(network).to("cuda", dtype, memory_format=torch.channels_last)
            answer = (
                there.in_bands(x.to("cuda", dtype, memory_format=torch.channels_last)).float().cpu()
            )
            assert (answer - expected).abs().max() < tolerance * max(1, expected.abs().max())


@EACH_FORM
@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_a_training_ends_where_the_cpu_s_does(tmp_path, settings, precision):
    part = write_frames(tmp_path, count=3)
    training = TRAINING | {"aligned": settings["form"] == "kernels"}
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
    on_gpu = [run for run in runs if run["device"] == "cuda"]
    assert [run["precision"] for run in on_gpu] == ["float32", "bfloat16"]
    assert all(run["whole_ms"] > 0 and run["product_macs"] > 0 for run in on_gpu)
