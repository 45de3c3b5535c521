"""The benchmark for GPUs does each part once, stops in time and goes on from where it was."""

import json
import shutil
import time
from types import SimpleNamespace

import gpu
import gpu_checks
import gpu_rates
import pandas as pd
import pytest
import torch
import trimesh
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.training import cuda_graph
from neural_shadows.training.training_run import TrainingRun

CPU = torch.device("cpu")
STEPS, SEEDS = (4, 8), (5, 6)


@pytest.fixture(autouse=True)
def no_gpu(monkeypatch):
    """A recording that does the step instead of replaying it; small works."""
    monkeypatch.setattr(cuda_graph, "aside", lambda step: step())
    monkeypatch.setattr(cuda_graph, "capture", lambda step: SimpleNamespace(replay=step))
    for name, value in {"WIDTH": 16, "RAYS": 256, "STEPS": 2, "FIELD_STEPS": 3}.items():
        monkeypatch.setattr(gpu_checks, name, value)
    monkeypatch.setattr(gpu_checks, "FIELD", gpu_checks.FIELD | {"resolution": 16})
    monkeypatch.setattr(gpu_rates, "FIELD", gpu_checks.FIELD)
    sizes = {"WIDTHS": (16,), "PRECISIONS": ("float32",), "BATCH": 64, "QUERY": 64}
    for name, value in (sizes | {"REPEATS": 1, "ROUNDS": 1}).items():
        monkeypatch.setattr(gpu_rates, name, value)
    monkeypatch.setattr(gpu, "SMALL", {"directions": 4, "points_per_direction": 100})


@pytest.fixture
def call(tmp_path, monkeypatch):
    """The program on a ball, whose curves have two budgets and seeds of a tiny network."""
    ball = tmp_path / "ball.ply"
    trimesh.creation.icosphere(3).export(ball)
    values = shipped("smoke", dragon=str(ball))
    values["samplings"]["poisson_quadtree"] |= {"directions": 8, "points_per_direction": 100}
    values["rendering"] |= {"width": 64, "height": 64}
    values["networks"]["thesis"] |= {"width": 8, "hidden_layers": 1}
    settings = resolved(read_config(values))
    points = {}
    for name in ("dragon", "dragon_identity"):
        points[name] = []
        for steps in STEPS:
            for seed in SEEDS:
                key = f"{name}_{steps}_steps_seed_{seed}"
                points[name].append({"experiment": key, "steps": steps, "seed": seed})
                training = settings["experiments"][name]["training"] | {"steps": steps}
                new = settings["experiments"][name] | {"training": training, "seed": seed}
                settings["experiments"][key] = new
    settings["learning_curves"] = points
    monkeypatch.setattr(gpu, "settings_of", lambda overlay, mesh: settings)
    kept = ["--mesh", str(ball), "--work", str(tmp_path / "work"), "--views", "2"]

    def main(out, minutes):
        kept_too = ["--out", str(tmp_path / out), "--minutes", str(minutes), "--device", "cpu"]
        gpu.main(kept + kept_too)
        return tmp_path / out

    return main


def test_goes_on_with_each_call(call, tmp_path, monkeypatch, capsys):
    """Stopped after each training's first point, it comes to the same as undisturbed."""
    whole = call("whole", 5)
    checks = json.loads((whole / "checks.json").read_text())
    assert len(checks) == 9 and all(check["passed"] for check in checks), checks
    rates = pd.read_csv(whole / "rates.csv")
    assert len(rates) == 4 and (rates["rate"] > 0).all()
    assert "\n0 trainings of the learning curves are left" in capsys.readouterr().out
    check_files(whole)

    (tmp_path / "stopped").mkdir()
    for name in ("checks.json", "rates.csv"):  # done already
        shutil.copy(whole / name, tmp_path / "stopped")
    monkeypatch.setattr(gpu, "agreement", None)
    monkeypatch.setattr(gpu, "rates", None)
    # The clock jumps ahead at each point of a curve.
    clock, add_point, states = [0.0], TrainingRun.add_point, []

    def late(run):
        add_point(run)
        clock[0] += 25.0

    with monkeypatch.context() as changed:
        changed.setattr(TrainingRun, "add_point", late)
        changed.setattr(time, "monotonic", lambda: clock[0])
        while not states or states[-1]:
            stopped = call("stopped", 7)
            states.append([path.name for path in stopped.glob("*.safetensors")])
            assert len(states) < 9
    assert len(states) > 2 and max(map(len, states)) == 1
    assert "\n0 trainings of the learning curves are left" in capsys.readouterr().out
    for name in ("losses.csv", "metrics.csv"):
        pd.testing.assert_frame_equal(pd.read_csv(stopped / name), pd.read_csv(whole / name))


def check_files(out):
    """The trainings in the order that was meant, and what is written of them."""
    trainings = json.loads((out / "trainings.json").read_text())
    assert list(trainings) == [
        f"{name}_{steps}_steps_seed_{seed}"
        for name in ("dragon", "dragon_identity")
        for seed in SEEDS
        for steps in STEPS
    ]
    record = trainings["dragon_8_steps_seed_6"]
    assert record["samples"] == 8 * record["training"]["batch_size"]
    assert record["training"]["seed"] == 6 and record["no_shadow_loss"] > 0
    metrics = pd.read_csv(out / "metrics.csv")
    assert list(metrics) == ["scene", "view", "view_set", "method", "metric", "value"]
    names = ["psnr", "ssim", "shadow_error", "false_shadow", "light_leak"]
    assert (metrics.groupby(["scene", "method"]).size() == 2 * 2 * len(names)).all()
    null = metrics[metrics["method"] == "no_shadow"].groupby("metric")["value"].mean()
    assert null["false_shadow"] == 0 and null["light_leak"] == null["shadow_error"] > 0
    losses = pd.read_csv(out / "losses.csv")
    assert list(losses) == ["experiment", "step", "samples", "learning_rate", "loss"]
    points = losses.groupby("experiment").size()
    assert points.to_dict() == {
        key: int(key.split("_steps")[0].split("_")[-1]) for key in trainings
    }


def test_a_check_that_finds_a_difference_or_cannot_be_done(monkeypatch):
    """A device that is another one, and one that is not there."""
    forward = FrequencyNetwork.forward

    def off(self, origins, directions, dtype):
        off.calls += 1
        return forward(self, origins, directions, dtype) + 0.01 * (off.calls % 2)

    off.calls = 0
    monkeypatch.setattr(FrequencyNetwork, "forward", off)
    check = gpu_checks._done(lambda: gpu_checks._depths(CPU, "float32"), 1e-3)
    assert not check["passed"] and check["error"] == pytest.approx(0.01, abs=1e-4)
    failed = gpu_checks._done(lambda: gpu_checks._indices(torch.device("cuda:99")), 0)
    assert not failed["passed"] and "Traceback" in failed["failure"]
