"""Training learns an analytic scene, repeats itself to the bit, and survives being killed."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import torch
import trimesh
from rays import ball_rays

from neural_shadows.errors import InputError
from neural_shadows.networks.kind_module import kind_module
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import load_network, load_tensors, save_tensors
from neural_shadows.training import cuda_graph as recorded_step
from neural_shadows.training import train as training
from neural_shadows.training.batches import DeviceRays, HostRays
from neural_shadows.training.train import may_be_recorded, train
from neural_shadows.training.training_run import (
    TrainingRun,
    chunk_size,
    gradient_pool,
    learning_rate_at,
)

POOL = gradient_pool(1)

SETTINGS = {
    "name": "ball",
    "network": {"encoding": "frequency", "frequencies": 3, "width": 64, "hidden_layers": 2},
    "steps": 400,
    "batch_size": 512,
    "learning_rate": 5e-3,
    "schedule": "cosine",
    "loss": {"false_shadow": 1.0, "light_leak": 1.0, "middle_pull": 0.0},
    "seed": 1,
    "mesh_ply": None,
    "data": {"rays": 20_000},
    "precision": "float32",
    "device": "cpu",
    "threads": 1,
}
TINY = SETTINGS | {
    "network": {"encoding": "frequency", "frequencies": 1, "width": 8, "hidden_layers": 1},
    "steps": 20,
    "batch_size": 32,
}


class BallRays:
    """Rays at a ball of radius 0.5 about the origin, half of them hits, with exact labels.

    Args:
        stop_after: raises KeyboardInterrupt in the `gather` after so many.
    """

    def __init__(self, count: int = 20_000, stop_after: int | None = None):
        self.arrays = ball_rays(count)
        self.count = count
        self.gathers = 0
        self.stop_after = stop_after

    def gather(self, indices):
        if self.gathers == self.stop_after:
            raise KeyboardInterrupt
        self.gathers += 1
        return tuple(array[indices] for array in self.arrays)


def run_training(folder: Path, rays: BallRays | None = None, **changes) -> BallRays:
    """Train in `folder` with `SETTINGS` and changes; gives the rays, which count their use."""
    rays = rays or BallRays()
    train(
        rays,
        folder / "weights.safetensors",
        folder / "loss.csv",
        folder / "training.json",
        state_folder=folder / "unfinished",
        **(SETTINGS | changes),
    )
    return rays


def contents(folder: Path) -> tuple[bytes, bytes]:
    """What must be the same in runs that are the same; the record holds times and is not."""
    return (folder / "weights.safetensors").read_bytes(), (folder / "loss.csv").read_bytes()


@pytest.fixture(autouse=True)
def keep_threads():
    before = torch.get_num_threads()
    yield
    torch.set_num_threads(before)


@pytest.fixture(scope="module")
def trained(tmp_path_factory) -> Path:
    """A folder with a finished run of `SETTINGS`."""
    folder = tmp_path_factory.mktemp("trained")
    run_training(folder)
    return folder


def test_threads_do_not_change_the_weights(tmp_path):
    run_training(tmp_path / "one", **TINY | {"batch_size": 6000, "threads": 1})
    run_training(tmp_path / "three", **TINY | {"batch_size": 6000, "threads": 3})
    assert contents(tmp_path / "one") == contents(tmp_path / "three")


def test_chunks_fill_a_cache_and_leave_work_for_two():
    cpu, cuda = torch.device("cpu"), torch.device("cuda")
    assert [chunk_size(batch, cpu, 2048) for batch in (16, 1023, 65536)] == [8, 512, 2048]
    assert chunk_size(65536, cuda, 2048) == 65536


def test_rays_of_this_file_are_right():
    o, d, t_lb, t_ub = (array.astype(float) for array in BallRays(1000).arrays)
    hit = np.isfinite(t_ub)
    assert np.linalg.norm(o, axis=1) == pytest.approx(1, abs=1e-6)
    assert 0.4 < hit.mean() < 0.9
    for t in (t_lb, t_ub):
        assert np.linalg.norm(o + t[:, None] * d, axis=1)[hit] == pytest.approx(0.5, abs=1e-5)
    assert t_lb[~hit] == pytest.approx(-2 * np.sum(o * d, axis=1)[~hit], abs=1e-6)


@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_learns_the_ball(tmp_path, precision):
    run_training(tmp_path, precision=precision)
    loss = pd.read_csv(tmp_path / "loss.csv")["loss"]
    assert loss.iloc[0] > 0.1
    assert loss.iloc[-20:].mean() < 0.03  # seeds 1 to 3 gave 0.018 to 0.021

    network, _ = load_network(tmp_path / "weights.safetensors")
    o, d, t_lb, t_ub = map(torch.from_numpy, BallRays().arrays)
    with torch.inference_mode():
        t = network(o, d, torch.float32)
    error = torch.relu(t_lb - t) + torch.relu(t - t_ub)
    assert error.mean() < 0.03  # the file holds the weights that the curve tells of


def test_files_of_a_run(trained):
    _, header = load_network(trained / "weights.safetensors")
    assert header["name"] == "ball"
    assert header["network"] == SETTINGS["network"]
    assert header["data"] == SETTINGS["data"]
    assert header["training"] == {
        "steps": 400,
        "batch_size": 512,
        "learning_rate": 5e-3,
        "schedule": "cosine",
        "loss": SETTINGS["loss"],
        "seed": 1,
        "device": "cpu",
        "precision": "float32",
    }
    record = json.loads((trained / "training.json").read_text())
    assert record.items() >= header.items()
    assert record["samples"] == 400 * 512
    assert record["parameters"] == 64 * 42 + 2 * 64 * 64 + 64
    assert record["seconds"] > 0 and record["samples_per_second"] > 0
    assert record["threads"] == 1 and record["machine"]["cpu"]

    curve = pd.read_csv(trained / "loss.csv")
    assert list(curve) == ["step", "samples", "learning_rate", "loss"]
    assert list(curve["step"]) == list(range(1, 401))
    assert (curve["samples"] == 512 * curve["step"]).all()
    assert record["final_loss"] == curve["loss"].iloc[-1]
    assert curve["learning_rate"].iloc[0] == 5e-3 > 1e-6 > curve["learning_rate"].iloc[-1]
    assert not (trained / "unfinished" / "ball").exists()


def test_points_of_the_curve_are_means(tmp_path, monkeypatch):
    """Seven points' worth of steps and a rest of two: the points' means are the steps' means."""
    run_training(tmp_path, **TINY | {"steps": 30})
    losses = pd.read_csv(tmp_path / "loss.csv")["loss"]
    monkeypatch.setattr(training, "CURVE_POINTS", 7)  # 30 // 7 = 4 steps each
    run_training(tmp_path, **TINY | {"steps": 30})
    curve = pd.read_csv(tmp_path / "loss.csv")
    assert list(curve["step"]) == [4, 8, 12, 16, 20, 24, 28, 30]
    means = [part.mean() for part in np.split(losses, curve["step"][:-1])]
    assert curve["loss"].to_numpy() == pytest.approx(means, rel=1e-5)


def test_the_same_seed_gives_the_same_bytes(tmp_path, trained):
    run_training(tmp_path)
    assert contents(tmp_path) == contents(trained)


def test_another_seed_gives_other_weights(tmp_path):
    run_training(tmp_path / "1", **TINY)
    run_training(tmp_path / "2", **TINY | {"seed": 2})
    for ours, theirs in zip(contents(tmp_path / "1"), contents(tmp_path / "2"), strict=True):
        assert ours != theirs


def test_the_seed_decides_the_first_weights(tmp_path):
    run_training(tmp_path, **TINY | {"seed": 7, "steps": 1, "learning_rate": 1e-12})
    network, _ = load_network(tmp_path / "weights.safetensors")
    expected = make_network(TINY["network"])
    expected.initialise(7)
    for ours, theirs in zip(network.parameters(), expected.parameters(), strict=True):
        torch.testing.assert_close(ours, theirs, rtol=0, atol=1e-9)


# A parent that has loaded torch starts trainings as its children and kills them. Each child
# is killed up to 30 ms after it saved a state of its own, which it does every 20 ms: now in a
# step, now in the middle of writing.
KILLER = """
import json, os, random, signal, sys, time
from pathlib import Path
import test_training as tests

undisturbed, killed = map(Path, sys.argv[1:])
settings = tests.TINY | {"steps": 800, "batch_size": 64, "state_interval_s": 0.02}
random.seed(4)

def start(folder):
    child = os.fork()
    if not child:
        rays = tests.run_training(folder, **settings)
        (folder / "gathers.json").write_text(str(rays.gathers))
        os._exit(0)
    return child

def saved_step():
    states = list(killed.glob("unfinished/*/state.safetensors"))
    return tests.load_tensors(states[0])[1]["step"] if states else 0

assert os.waitpid(start(undisturbed), 0)[1] == 0
killed_at = [0]
for _ in range(5):
    child = start(killed)
    while saved_step() == killed_at[-1]:
        time.sleep(0.005)
    time.sleep(random.uniform(0, 0.03))
    os.kill(child, signal.SIGKILL)
    assert os.WIFSIGNALED(os.waitpid(child, 0)[1]), "ended before it was killed"
    killed_at.append(saved_step())
assert not (killed / "weights.safetensors").exists()
assert os.waitpid(start(killed), 0)[1] == 0
print(json.dumps(killed_at))
"""


def test_killed_runs_end_in_the_same_bytes(tmp_path):
    undisturbed, killed = tmp_path / "undisturbed", tmp_path / "killed"
    done = subprocess.run(
        [sys.executable, "-c", KILLER, undisturbed, killed],
        cwd=Path(__file__).parent,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=100,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    killed_at = json.loads(done.stdout)  # the saved state's step after each kill
    assert len(killed_at) == 6 and (np.diff(killed_at) > 0).all()
    assert (undisturbed / "gathers.json").read_text() == "800"
    # The last run went on from the last saved state, and did not begin again.
    assert (killed / "gathers.json").read_text() == str(800 - killed_at[-1])
    assert contents(killed) == contents(undisturbed)


def interrupt(folder: Path, after: int) -> None:
    """A run of `TINY` that saved its state at each of `after` steps and was stopped."""
    with pytest.raises(KeyboardInterrupt):
        run_training(folder, BallRays(stop_after=after), **TINY, state_interval_s=0.0)


def test_the_same_settings_resume(tmp_path, capsys):
    interrupt(tmp_path, 12)
    capsys.readouterr()
    assert run_training(tmp_path, **TINY).gathers == 20 - 12
    shown = capsys.readouterr().err.split("\r")[1:]
    assert f"{12 * 32}/640" in shown[0]  # where the bar begins
    assert len(shown) <= 4  # every two seconds a line, and not at every point of the curve


def test_a_run_whose_files_were_lost_is_not_trained_again(tmp_path):
    """Snakemake deletes the files of a job that was killed before it had noted the job's end."""
    run_training(tmp_path, **TINY, state_interval_s=0.0)
    before = contents(tmp_path)
    for name in ("weights.safetensors", "loss.csv", "training.json"):
        (tmp_path / name).unlink()
    assert run_training(tmp_path, **TINY).gathers == 0
    assert contents(tmp_path) == before


def test_a_short_run_keeps_no_state(tmp_path):
    run_training(tmp_path, **TINY)
    assert not (tmp_path / "unfinished").exists()


def test_the_kept_state_is_the_last(tmp_path):
    interrupt(tmp_path, 12)
    run_training(tmp_path, **TINY)  # ends long before the next state would be saved
    (state,) = tmp_path.glob("unfinished/*/state.safetensors")
    assert load_tensors(state)[1]["step"] == 20


@pytest.mark.parametrize(
    "change",
    [
        {"name": "balls"},
        {"network": {"encoding": "frequency", "frequencies": 1, "width": 8, "hidden_layers": 2}},
        {"steps": 21},
        {"batch_size": 33},
        {"learning_rate": 2e-3},
        {"schedule": "constant"},
        {"seed": 2},
        {"data": {"rays": 20_000, "seed": 2}},
        {"precision": "bfloat16"},
    ],
    ids=lambda change: next(iter(change)),
)
def test_changed_settings_start_anew(tmp_path, change):
    interrupt(tmp_path, 12)
    settings = TINY | change
    assert run_training(tmp_path, **settings).gathers == settings["steps"]
    # The other run can still go on.
    assert run_training(tmp_path, **TINY).gathers == 20 - 12


def test_changed_code_starts_anew(tmp_path, monkeypatch):
    interrupt(tmp_path, 12)
    edited = tmp_path / "network.py"
    edited.write_text(kind_module("frequency").read_text() + "# edited\n")
    monkeypatch.setattr(training, "kind_module", lambda encoding: edited)
    assert run_training(tmp_path, **TINY).gathers == 20


def test_a_state_that_is_complete_is_not_trained_further(tmp_path, monkeypatch):
    """Killed between the last step and the writing of the weights."""

    def fail(*_):
        raise OSError("disk full")

    with monkeypatch.context() as patch:
        patch.setattr(training, "save_network", fail)
        with pytest.raises(OSError, match="disk full"):
            run_training(tmp_path / "killed", **TINY, state_interval_s=0.0)
    assert run_training(tmp_path / "killed", **TINY).gathers == 0
    run_training(tmp_path / "undisturbed", **TINY)
    assert contents(tmp_path / "killed") == contents(tmp_path / "undisturbed")


@pytest.mark.parametrize(
    "network",
    [
        {"encoding": "occupancy_field", "resolution": 16, "surface": "solid", "stored": "int8"},
        {"encoding": "occupancy_field", "resolution": 16, "surface": "sheet", "stored": "int8"},
        {
            "encoding": "hash_grid",
            "points": 2,
            "grids": [4, 8],
            "channels": 2,
            "width": 8,
            "hidden_layers": 1,
            "head": "depth_confidence",
            "stored": "float32",
            "occupancy": 8,
            "table_size": 64,
        },
    ],
    ids=lambda network: f"{network['encoding']}-{network.get('surface')}",
)
def test_other_kinds_resume_and_do_not_depend_on_threads(tmp_path, network):
    """What their losses draw depends on the seed, the step and the chunk, and on nothing else."""
    trimesh.creation.icosphere(3, radius=0.5).export(tmp_path / "mesh.ply")
    settings = TINY | {"network": network, "mesh_ply": tmp_path / "mesh.ply", "batch_size": 128}
    run_training(tmp_path / "whole", **settings)
    with pytest.raises(KeyboardInterrupt):
        stopped = BallRays(stop_after=12)
        run_training(tmp_path / "killed", stopped, **settings, state_interval_s=0.0)
    assert run_training(tmp_path / "killed", **settings).gathers == 20 - 12
    run_training(tmp_path / "threads", **settings | {"threads": 2})
    other = settings | {"seed": settings["seed"] + 1}
    run_training(tmp_path / "other", **other)
    whole = contents(tmp_path / "whole")
    assert contents(tmp_path / "killed") == contents(tmp_path / "threads") == whole
    assert contents(tmp_path / "other") != whole


def test_a_damaged_state_is_moved_aside_and_the_training_begins_anew(tmp_path):
    interrupt(tmp_path / "a", 12)
    (state,) = tmp_path.glob("a/unfinished/*/state.safetensors")
    state.write_bytes(state.read_bytes()[:-10])
    with pytest.raises(InputError, match="state.safetensors: not a whole file.*moved to"):
        run_training(tmp_path / "a", **TINY)
    run_training(tmp_path / "a", **TINY)
    run_training(tmp_path / "b", **TINY)
    assert contents(tmp_path / "a") == contents(tmp_path / "b")


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        # One value in a tensor's place would be taken for all of it.
        (lambda tensors, header: tensors.update({"output": torch.ones(1)}), "output has the shape"),
        (lambda tensors, header: tensors.pop("exp_avg.output"), "'exp_avg.output'"),
        (lambda tensors, header: header.pop("step"), "'step'"),
        (lambda tensors, header: header.update(step=-1), "its step is -1"),
        (lambda tensors, header: header.update(step=1.5), "its step is 1.5"),
        (lambda tensors, header: header.update(curve=[[1, 2]]), "not enough values"),
    ],
    ids=["shape", "tensor", "no step", "negative", "half", "curve"],
)
def test_a_state_of_something_else_is_moved_aside(tmp_path, change, reason):
    def run() -> TrainingRun:
        network = make_network(TINY["network"])
        network.initialise(1)
        return TrainingRun(network, torch.device("cpu"), DeadZone(), 0)

    state = tmp_path / "state.safetensors"
    run().save(state)
    tensors, header = load_tensors(state)
    change(tensors, header)
    save_tensors(state, tensors, header)
    fresh = run()
    with pytest.raises(InputError, match=rf"not a state of this training \(.*{reason}.*moved to"):
        fresh.restore(state)
    assert not state.exists()
    for ours, theirs in zip(fresh.weights, run().weights, strict=True):
        assert torch.equal(ours, theirs)  # nothing of it was taken


def test_restored_state_is_the_saved_one(tmp_path):
    rays = BallRays()

    def new_run(seed: int) -> TrainingRun:
        network = make_network(TINY["network"])
        network.initialise(seed)
        return TrainingRun(network, torch.device("cpu"), DeadZone(), 0)

    run = new_run(1)
    for step in range(5):
        take_step(run, rays, np.arange(64) + step)
    run.curve, run.seconds = [[5, 1e-3, 1 / 3]], 0.1 + 0.2
    run.save(tmp_path / "state.safetensors")
    other = new_run(2)
    other.restore(tmp_path / "state.safetensors")
    assert (other.step, other.curve, other.seconds) == (5, run.curve, run.seconds)
    other.save(tmp_path / "again.safetensors")
    state = (tmp_path / "state.safetensors").read_bytes()
    assert (tmp_path / "again.safetensors").read_bytes() == state
    tensors, _ = load_tensors(tmp_path / "state.safetensors")
    assert len(tensors) == 3 * 3  # weights and both of Adam's means
    for one in (run, other):  # and Adam's own count of steps, for its bias correction
        take_step(one, rays, np.arange(64))
    for ours, theirs in zip(run.network.parameters(), other.network.parameters(), strict=True):
        assert torch.equal(ours, theirs)


def set_weights(monkeypatch, change) -> None:
    initialise = FrequencyNetwork.initialise

    def changed(self, seed):
        initialise(self, seed)
        with torch.no_grad():
            change(self)

    monkeypatch.setattr(FrequencyNetwork, "initialise", changed)


def assert_stops(folder: Path, reason: str, **changes) -> None:
    with pytest.raises(InputError) as caught:
        run_training(folder, **TINY | changes)
    message = str(caught.value)
    assert message.startswith("training ball: ") and "\n" not in message
    assert reason in message and "`learning_rate`" in message
    assert not (folder / "weights.safetensors").exists()


def test_a_dead_output_stops(tmp_path, monkeypatch):
    set_weights(monkeypatch, lambda network: network.output.zero_())
    assert_stops(tmp_path, "the same for every ray (its output died) at step 1;")


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_loss_that_is_not_finite_stops(tmp_path, monkeypatch, value):
    set_weights(monkeypatch, lambda network: network.layers[0].fill_(value))
    assert_stops(tmp_path, "the loss is nan at step 1;")


def test_a_rate_that_is_too_high_stops(tmp_path):
    """Adam moves every weight by the rate: by 1 in the first step, and the ReLUs die."""
    assert_stops(tmp_path, "(its output died)", learning_rate=1.0, steps=200, schedule="constant")


def take_step(
    run: TrainingRun, rays: BallRays, indices: np.ndarray, rate: float = 1e-3, chunk: int = 1000
) -> tuple[float, float]:
    """A step on these rays; gives the batch's mean loss and the spread of the outputs."""
    before = run.loss_sum.item()
    batch = HostRays(rays, torch.device("cpu")).gather(torch.from_numpy(indices))
    run.train_step(batch, torch.tensor(rate, dtype=torch.float64), torch.float32, chunk, POOL)
    return run.loss_sum.item() - before, run.spread.item()


def first_run(seed: int = 0) -> TrainingRun:
    network = FrequencyNetwork(frequencies=3, width=16, hidden_layers=2)
    network.initialise(seed)
    return TrainingRun(network, torch.device("cpu"), DeadZone(), 0)


@pytest.mark.parametrize("chunk", [100, 64, 7])
def test_chunks_add_up_to_the_batch(chunk):
    whole, chunked = first_run(), first_run()
    indices = np.arange(100)
    loss, spread = take_step(whole, BallRays(), indices, chunk=100)
    parts_loss, parts_spread = take_step(chunked, BallRays(), indices, chunk=chunk)
    assert parts_loss == pytest.approx(loss, rel=1e-6)
    assert parts_spread == pytest.approx(spread, rel=1e-6)
    for ours, theirs in zip(chunked.network.parameters(), whole.network.parameters(), strict=True):
        torch.testing.assert_close(ours.grad, theirs.grad, rtol=1e-5, atol=1e-7)
        assert theirs.grad.abs().max() > 1e-3


def test_spread_is_that_of_the_whole_batch():
    """A last chunk of one ray has none of its own, which is no dead network."""
    _, spread = take_step(first_run(), BallRays(), np.arange(65), chunk=64)
    assert spread > 0.01


def test_gradient_against_differences():
    """The step's gradient is that of the mean loss: central differences in float64's stead."""
    run, rays = first_run(), BallRays()
    indices = np.arange(200)
    take_step(run, rays, indices, rate=0.0)  # the weights stay
    weight = run.network.output
    step = 1e-2  # the loss is piecewise linear in it: the step may be large beside rounding
    differences = []
    for i in range(weight.shape[1]):
        losses = []
        for sign in (1, -1):
            other = first_run()
            with torch.no_grad():
                other.network.output[0, i] += sign * step
            losses.append(take_step(other, rays, indices, rate=0.0)[0])
        differences.append((losses[0] - losses[1]) / (2 * step))
    assert weight.grad[0].tolist() == pytest.approx(differences, abs=0.02)
    assert max(map(abs, differences)) > 0.2


@pytest.mark.parametrize("rate", [1e-2, 1e-4])
def test_a_step_moves_by_its_rate(rate):
    """Adam's first step moves a weight by the rate, whatever its gradient."""
    run, before = first_run(), first_run()
    take_step(run, BallRays(), np.arange(200), rate)
    assert run.step == 1
    moved = (run.network.output - before.network.output).abs().max().item()
    assert moved == pytest.approx(rate, rel=0.01)


def test_learning_rates():
    def rates(steps, **settings) -> list[float]:
        return [
            learning_rate_at(torch.tensor(step), steps=100, learning_rate=0.01, **settings).item()
            for step in steps
        ]

    assert rates((0, 50, 99), schedule="constant") == [0.01] * 3
    cosine = rates(range(101), schedule="cosine")
    assert cosine[0] == 0.01
    assert cosine[25] == pytest.approx(0.01 * (1 + math.sqrt(0.5)) / 2)
    assert cosine[50] == pytest.approx(0.005)
    assert cosine[100] == pytest.approx(0, abs=1e-12)
    assert (np.diff(cosine) < 0).all()


def test_a_recorded_step_gives_the_same_bytes(tmp_path, monkeypatch):
    """The loop that a GPU runs, with a recording that does the step instead of replaying it."""

    class Replaying:
        def __init__(self, step):
            self.replay = step

    aside = []
    monkeypatch.setattr(recorded_step, "aside", lambda step: (aside.append(1), step()))
    monkeypatch.setattr(recorded_step, "capture", Replaying)
    run_training(tmp_path / "plain", **TINY)
    monkeypatch.setattr(training, "may_be_recorded", lambda *_: True)
    run_training(tmp_path / "recorded", **TINY)
    assert len(aside) == recorded_step.WARM_UP
    assert contents(tmp_path / "recorded") == contents(tmp_path / "plain")


def test_only_steps_of_fixed_shape_on_a_gpu_are_recorded(tmp_path):
    cuda, cpu = torch.device("cuda"), torch.device("cpu")
    network = make_network(TINY["network"])
    other = make_network(
        {"encoding": "occupancy_field", "resolution": 8, "surface": "solid", "stored": "int8"}
    )
    on_device, on_host = DeviceRays.__new__(DeviceRays), HostRays(BallRays(10), cpu)
    assert may_be_recorded(network, cuda, on_device)
    assert not may_be_recorded(network, cpu, on_device)
    assert not may_be_recorded(network, cuda, on_host)
    assert not may_be_recorded(other, cuda, on_device)
