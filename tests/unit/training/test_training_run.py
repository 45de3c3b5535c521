"""Loss, gradient and weights of a step; saved states."""

import math

import pytest
import torch
from rays import ball_rays

from neural_shadows.errors import InputError
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.shadow_network import LabelledBatch
from neural_shadows.training.training_run import TrainingRun
from neural_shadows.training.training_state import learning_rate_at
from neural_shadows.training.workers import Workers

RAYS = [torch.from_numpy(part) for part in ball_rays(1000)]
SETTINGS = {
    "optimiser": "adam",
    "steps": 100,
    "batch_size": 1000,
    "learning_rate": 1e-3,
    "schedule": "constant",
    "loss": {},
    "seed": 0,
    "device": "cpu",
    "precision": "float32",
}


def new_run(seed: int = 0, chunk: int = 1000, **changes) -> TrainingRun:
    network = FrequencyNetwork(frequencies=3, width=16, hidden_layers=2)
    network.initialise(seed)
    run = TrainingRun(network, SETTINGS | changes)
    run.chunk = chunk
    return run


def take_step(run: TrainingRun, rays: slice) -> tuple[float, float]:
    """A step on these rays; gives the batch's mean loss and the spread of the outputs."""
    before = run.loss_sum.item()
    run.train_step(LabelledBatch(*(part[rays] for part in RAYS)))
    return run.loss_sum.item() - before, run.spread.item()


def assert_same_weights(ours: TrainingRun, theirs: TrainingRun) -> None:
    for first, other in zip(ours.weights.values(), theirs.weights.values(), strict=True):
        assert torch.equal(first, other)


@pytest.mark.parametrize("chunk", [99, 64, 7])
def test_chunks_add_up_to_the_batch(chunk):
    """The spread of the outputs too: a last chunk of one ray has none of its own."""
    whole, chunked = new_run(), new_run(chunk=chunk)
    expected, result = take_step(whole, slice(100)), take_step(chunked, slice(100))
    assert result == pytest.approx(expected, rel=1e-6)
    assert expected[1] > 0.01
    for ours, theirs in zip(chunked.weights.values(), whole.weights.values(), strict=True):
        torch.testing.assert_close(ours.grad, theirs.grad, rtol=1e-5, atol=1e-7)
        assert theirs.grad.abs().max() > 1e-3


def test_gradient_against_differences():
    """The step's gradient is that of the mean loss: central differences in float64's stead."""
    run = new_run()
    take_step(run, slice(200))
    gradient = run.network.output.grad
    step = 3e-3  # the loss is piecewise linear in it: the step may be large beside rounding
    differences = []
    for i in range(gradient.shape[1]):
        losses = []
        for sign in (1, -1):
            other = new_run()
            other.network.output.data[0, i] += sign * step
            losses.append(take_step(other, slice(200))[0])
        differences.append((losses[0] - losses[1]) / (2 * step))
    assert gradient[0].tolist() == pytest.approx(differences, abs=0.02)
    assert max(map(abs, differences)) > 0.2


def test_rates_of_schedules():
    """Those of Hu et al. 2025 (5): 0.001, a tenth from step 20,000 on, a hundredth from 40,000."""
    settings = {"learning_rate": 1e-3, "steps": 50_000}
    step_numbers = torch.tensor([0, 19_999, 20_000, 39_999, 40_000, 49_999])

    def rates(schedule, **more):
        schedule_settings = settings | {"schedule": schedule, **more}
        return [learning_rate_at(step, schedule_settings).item() for step in step_numbers]

    assert rates("constant") == [1e-3] * 6
    falling = [1e-3, 1e-3, 1e-4, 1e-4, 1e-5, 1e-5]
    assert rates("steps", tenth_from=[20_000, 40_000]) == pytest.approx(falling, rel=1e-12)
    cosine = [5e-4 * (1 + math.cos(math.pi * int(step) / 50_000)) for step in step_numbers]
    assert rates("cosine") == pytest.approx(cosine, rel=1e-9)


def test_steps_are_those_of_torch_s_adam():
    ours, theirs = new_run(learning_rate=1e-2), new_run()
    adam = torch.optim.Adam(theirs.weights.values(), lr=torch.tensor(1e-2), fused=True)
    for step in range(4):
        take_step(ours, slice(100 * step, 100 * step + 100))
        batch = LabelledBatch(*(part[100 * step : 100 * step + 100] for part in RAYS))
        losses, _ = theirs.network.losses(batch, theirs.dead_zone, torch.float32, None)
        adam.zero_grad()
        (losses.sum() / 100).backward()
        adam.step()
    assert_same_weights(ours, theirs)


def test_muon_moves_the_hidden_layers_and_adam_the_others():
    """As torch's own optimisers do, over a schedule; the same in a pool's threads to the bit.

    Within what torch's bfloat16 products round: a tenth of a step of 0.02.
    """
    changes = {"optimiser": "muon", "adam_rate": 1e-3, "learning_rate": 2e-2, "schedule": "cosine"}
    ours, pooled, theirs = new_run(**changes), new_run(**changes), new_run()
    hidden = [theirs.weights[f"layers.{number}"] for number in (1, 2)]
    others = [theirs.weights[name] for name in ("layers.0", "output")]
    muon = torch.optim.Muon(hidden, lr=2e-2, weight_decay=0.0)
    adam = torch.optim.Adam(others, lr=1e-3, fused=True)
    for step in range(4):
        rays = slice(100 * step, 100 * step + 100)
        take_step(ours, rays)
        with Workers(2) as pool:
            pooled.train_step(LabelledBatch(*(part[rays] for part in RAYS)), pool)
        batch = LabelledBatch(*(part[rays] for part in RAYS))
        losses, _ = theirs.network.losses(batch, theirs.dead_zone, torch.float32, None)
        share = 0.5 * (1 + math.cos(math.pi * step / 100))
        for optimiser, rate in ((muon, 2e-2), (adam, 1e-3)):
            optimiser.param_groups[0]["lr"] = rate * share
            optimiser.zero_grad()
        (losses.sum() / 100).backward()
        muon.step()
        adam.step()
    assert_same_weights(pooled, ours)
    before = new_run().weights
    for name, weight in ours.weights.items():
        torch.testing.assert_close(weight, theirs.weights[name], rtol=0, atol=2e-3)
        assert (weight - before[name]).abs().max() > 2e-3


@pytest.mark.parametrize("died_at_step", [None, 1])
def test_a_state_keeps_its_divergence(tmp_path, died_at_step):
    """Its spread is not in the state: without the word a dead run would go on."""
    ours, theirs = new_run(), new_run(seed=1)
    if died_at_step:
        ours.network.output.data.zero_()
    take_step(ours, slice(100))
    ours.add_point()
    assert ours.died_at_step == died_at_step
    ours.save(tmp_path / "state.safetensors")
    theirs.restore(tmp_path / "state.safetensors")
    assert (theirs.died_at_step, theirs.curve) == (died_at_step, ours.curve)
    assert_same_weights(ours, theirs)


def test_muon_is_refused_without_hidden_layers():
    network = FrequencyNetwork(frequencies=3, width=16, hidden_layers=2)
    network.layers = network.layers[:1]
    settings = SETTINGS | {"optimiser": "muon", "adam_rate": 1e-3}
    with pytest.raises(
        InputError, match="muon: the network has no hidden layers.*Set optimiser: adam"
    ):
        TrainingRun(network, settings)


@pytest.mark.usefixtures("any_format")
def test_the_loss_scale_keeps_small_gradients_in_float16():
    """One ray of 100,000 has a loss: its gradient, 1e-6, is next to float16's end at 6e-8."""
    parts = [part[:1].expand(100_000, *part.shape[1:]).clone() for part in RAYS]
    parts[2].fill_(0).index_fill_(0, torch.tensor([0]), 0.01)
    parts[3].fill_(math.inf).index_fill_(0, torch.tensor([0]), 0.01)

    def gradient(precision: str, scale: float) -> torch.Tensor:
        run = new_run(precision=precision)
        run.chunk, run.loss_scale = 100_000, scale
        run.train_step(LabelledBatch(*parts))
        return run.weights["layers.0"].grad

    assert new_run(precision="float16").loss_scale == 128.0
    assert new_run(precision="bfloat16").loss_scale == new_run().loss_scale == 1.0
    exact = gradient("float32", 1.0)
    assert torch.equal(gradient("float32", 128.0), exact)
    error = {scale: (gradient("float16", scale) - exact).norm() for scale in (1.0, 128.0)}
    assert error[128.0] < 0.005 * exact.norm() < error[1.0]  # 0.0006 and 0.022 of it
