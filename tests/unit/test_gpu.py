"""The benchmark for GPUs does each part once, stops in time and goes on from where it was."""

import json
import shutil
import time
from types import SimpleNamespace

import gpu
import gpu_checks
import gpu_curves
import gpu_data
import gpu_rates
import gpu_report
import numpy as np
import pandas as pd
import pytest
import torch
import trimesh
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.render_references import render_references
from neural_shadows.files.whole_files import write_text
from neural_shadows.networks.compute import is_native
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import load_tensors
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import open_scene
from neural_shadows.training import cuda_graph
from neural_shadows.training.loss_curve import read_loss
from neural_shadows.training.training_run import TrainingRun

CPU = torch.device("cpu")
STEPS, SEEDS, BATCH = (4, 6, 8), (5, 6), 64
NAMES = ("dragon", "dragon_uniform")


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
    values["tables"]["learning_sampling"]["rows"] = {"dragon": list(NAMES)}
    values["samplings"]["poisson_quadtree"] |= {"directions": 8, "points_per_direction": 100}
    values["rendering"] |= {"width": 64, "height": 64}
    values["networks"]["thesis"] |= {"width": 8, "hidden_layers": 1}
    values["seed"] = SEEDS[0]
    values["trainings"]["base"] |= {"steps": STEPS[-1], "batch_size": BATCH}
    values["learning_curves"] = {"experiments": [*NAMES], "steps": [*STEPS], "seeds": len(SEEDS)}
    settings = resolved(read_config(values))
    monkeypatch.setattr(gpu, "settings_of", lambda overlay, mesh: settings)
    kept = ["--mesh", str(ball), "--work", str(tmp_path / "work"), "--views", "2"]

    def main(out, minutes, *others):
        kept_too = ["--out", str(tmp_path / out), "--minutes", str(minutes), "--device", "cpu"]
        gpu.main([*kept, *kept_too, *others])
        return tmp_path / out

    main.settings = settings
    return main


def test_goes_on_with_each_call(call, tmp_path, monkeypatch, capsys):
    """Stopped after each training's first point, it comes to the same as undisturbed."""
    whole = call("whole", 5)
    checks = json.loads((whole / "checks.json").read_text())
    count = 11 if is_native(torch.float16, torch.device("cpu")) else 9
    assert len(checks) == count and all(check["passed"] for check in checks), checks
    rates = pd.read_csv(whole / "rates.csv")
    assert len(rates) == 4 and (rates["rate"] > 0).all()
    assert "\n0 trainings of the learning curves are left" in capsys.readouterr().out
    check_files(whole)
    with pytest.raises(SystemExit, match="whole: was made with other settings or of another mesh"):
        call("whole", 5, "--views", "1")
    check_reports(whole, call.settings, monkeypatch)

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
            assert len(states) < 14
    assert len(states) > 2 and max(map(len, states)) == 1
    assert "\n0 trainings of the learning curves are left" in capsys.readouterr().out
    files = sorted(path.relative_to(whole) for path in whole.glob("results/**/*.csv"))
    assert len(files) == 2 * 12 + 1
    for name in files:
        assert (stopped / name).read_bytes() == (whole / name).read_bytes()


def record_of(results, name):
    return json.loads((results / "networks" / name / "training.json").read_text())


def check_files(out):
    """What is written of the trainings, where the pipeline has it."""
    results = out / "results" / "smoke"
    names = [f"{name}_{n}_steps_seed_{seed}" for name in NAMES for seed in SEEDS for n in STEPS]
    names = [name.removesuffix("_8_steps_seed_5") for name in names]  # the experiment itself
    written = sorted(results.glob("networks/*/training.json"), key=lambda p: p.stat().st_mtime_ns)
    assert [path.parent.name for path in written] == names
    record = record_of(results, "dragon_8_steps_seed_6")
    assert record["samples"] == 8 * record["training"]["batch_size"] == 8 * BATCH
    assert record["training"]["seed"] == 6 and record["no_shadow_loss"] > 0
    shown = {}
    for name in (*names, "no_shadow"):
        metrics = read_metrics([results / f"evaluations/dragon/{name}.000.csv"])
        assert set(metrics["method"]) == {name} and len(metrics) == 2 * 2 * 6
        shown[name] = metrics.groupby("metric")["value"].mean()
    null = shown["no_shadow"]
    assert null["false_shadow"] == 0 and null["light_leak"] == null["shadow_error"] > 0
    for name in names:
        losses = read_loss(results / f"networks/{name}/loss.csv")
        assert len(losses) == record_of(results, name)["training"]["steps"]


def check_reports(out, settings, monkeypatch):
    """Tables and claims of them: of curves that are whole, and of files that are there."""
    monkeypatch.chdir(out)
    names = ("sampling", "dragon_worse_than_512", "scene_difficulty")
    claims = {name: settings["claims"][name] for name in names}
    claims["sampling"] = claims["sampling"] | {"metrics": ["psnr"]}
    written = gpu_report.reports(settings | {"claims": claims})
    assert written == [
        f"reports/smoke/{name}.{end}"
        for name in ("learning_sampling", "claims")
        for end in ("csv", "md")
    ]
    made = pd.read_csv(out / written[0])
    assert len(set(made["method"])) == len(NAMES)
    budgets = sorted(made["samples"].unique())[:-1]
    assert budgets == [steps * BATCH for steps in STEPS]
    assert pd.read_csv(out / written[2])["claim"].tolist() == ["sampling"]


def test_frames_are_those_of_the_references(tmp_path):
    """Of the scene with a least share of shadow too."""
    values = shipped("smoke")
    values["rendering"] |= {"width": 96, "height": 64}
    values["scenes"]["landscape"]["least_shadow"] = 0.2
    settings = resolved(read_config(values))
    data = gpu_data.Data(settings, tmp_path, 1, views=2)
    files = data.mesh("landscape"), tmp_path / "000.safetensors"
    about = settings["scenes"]["landscape"]
    render_references(*files, scene=about["scene"], frames=about["frames"], first=0, last=2)
    batch = list(References(files[1]))
    opened, seed = open_scene(files[0], **about["scene"]), about["frames"]["seed"]
    others = draw_viewpoints(opened, ["centre"], range(2), 1.5, seed)  # whatever their shadow
    assert any((o.light != frame.view.light).any() for o, (frame, _) in zip(others, batch))
    for (ours, lit), (frame, truth) in zip(data.frames("landscape"), batch, strict=True):
        np.testing.assert_array_equal(ours.p, frame.p)
        np.testing.assert_array_equal(ours.view.light, frame.view.light)
        np.testing.assert_array_equal(lit, truth)


def test_weights_that_are_no_numbers_are_infinitely_apart():
    runs = [gpu_checks.new_run(16, 16, CPU, "float32") for _ in range(2)]
    runs[1].weights["output"].data[0, 0] = torch.nan
    assert gpu_checks._apart(*runs) == gpu_checks._apart(*runs[::-1]) == float("inf")


def test_a_training_is_kept_before_it_is_measured(call, tmp_path, monkeypatch):
    def killed(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(gpu_curves, "measured", killed)
    for name in ("checks.json", "rates.csv"):
        write_text(tmp_path / "out" / name, "done")
    with pytest.raises(KeyboardInterrupt):
        call("out", 5)
    (state,) = tmp_path.glob("out/*.safetensors")
    assert load_tensors(state)[1]["step"] == STEPS[0]


@pytest.mark.parametrize("died_at_step", [None, 1])
def test_a_dead_run_is_done_when_the_time_is_up(monkeypatch, died_at_step):
    monkeypatch.setattr(gpu_curves, "ray_points", lambda *_, **__: iter([1]))
    run = SimpleNamespace(settings={"steps": 8}, seconds=0.0, died_at_step=died_at_step)
    assert gpu_curves._train(run, None, 0.0, 1) == (died_at_step is not None)


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
