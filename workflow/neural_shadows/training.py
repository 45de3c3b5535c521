"""Training of a shadow network on a ray set: resumable, and reproducible from its seed."""

import hashlib
import json
import math
import time
from concurrent.futures import Executor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import torch
from torch import Tensor
from torch.optim.adam import adam

from neural_shadows.broken import broken
from neural_shadows.compute import choose_device, choose_dtype
from neural_shadows.dead_zone_loss import DeadZone
from neural_shadows.errors import InputError
from neural_shadows.files import write_json, write_text
from neural_shadows.hardware import describe_machine
from neural_shadows.module_graph import kind_module, modules_of
from neural_shadows.network_file import load_tensors, save_network, save_tensors
from neural_shadows.network_kinds import make_network
from neural_shadows.progress import progress_bar
from neural_shadows.recorded_step import recorded
from neural_shadows.shadow_network import LabelledBatch, ShadowNetwork
from neural_shadows.training_data import (
    BatchSource,
    DeviceRays,
    LabelledRays,
    batch_indices,
    batch_source,
)

# Points of the loss curve, each the mean loss since the point before.
CURVE_POINTS = 500

# Adam's running means, beside the weights in the saved state.
ADAM_STATE = ("exp_avg", "exp_avg_sq")


def learning_rate_at(step: Tensor, *, steps: int, learning_rate: float, schedule: str) -> Tensor:
    """Learning rate of a step: `constant`, or `cosine` from `learning_rate` down to zero.

    Args:
        step: int64 without dimensions.

    Returns:
        float64 without dimensions, on the same device.
    """
    rate = torch.full_like(step, learning_rate, dtype=torch.float64)
    if schedule == "cosine":
        rate = rate * 0.5 * (1 + torch.cos(math.pi * step.double() / steps))
    return rate


def state_digest(description: dict) -> str:
    """A name for a run's saved state: a digest of its settings, its data and the code.

    Changed settings, rays or training code thereby start anew and never resume from a
    state that they did not make.
    """
    digest = hashlib.sha256(json.dumps(description, sort_keys=True).encode())
    for module in (Path(__file__), kind_module(description["network"]["encoding"])):
        for path in (module, *modules_of(module)):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


class TrainingRun:
    """The changing state of one run: weights, Adam's means, step, loss curve, seconds.

    Args:
        seed: of what a network's loss draws.
    """

    def __init__(
        self,
        network: ShadowNetwork,
        device: torch.device,
        dead_zone: DeadZone,
        seed: int,
    ):
        self.network, self.dead_zone, self.seed = network.to(device), dead_zone, seed
        self.weights = list(network.parameters())
        self.step = torch.zeros((), dtype=torch.int64, device=device)
        self.loss_sum = torch.zeros((), device=device)  # of the steps since it was last zeroed
        self.spread = torch.zeros((), device=device)  # max − min of the last step's outputs
        self.seconds = 0.0
        self.curve: list[list[float]] = []  # [step, learning rate, mean loss since the last]
        self.means = {
            mean: {name: torch.zeros_like(weight) for name, weight in network.named_parameters()}
            for mean in ADAM_STATE
        }
        # Adam counts for each weight.
        self._adam_steps = [torch.zeros((), device=device) for _ in self.weights]

    def save(self, path: Path) -> None:
        """Write the whole state."""
        tensors = dict(self.network.state_dict())
        for mean, values in self.means.items():
            for name in values:
                tensors[f"{mean}.{name}"] = self.means[mean][name]
        header = {"step": int(self.step), "seconds": self.seconds, "curve": self.curve}
        save_tensors(path, tensors, header)

    def restore(self, path: Path) -> None:
        """Continue from a state that `save` wrote.

        Raises:
            InputError: the file is missing or not whole; or of another network, and moved aside.
        """
        tensors, header = load_tensors(path)
        places = {name: weight.data for name, weight in self.network.named_parameters()}
        for mean, values in self.means.items():
            places |= {f"{mean}.{name}": value for name, value in values.items()}
        try:
            for name, place in places.items():
                if tensors[name].shape != place.shape:  # a copy would repeat a single value
                    raise ValueError(f"{name} has the shape {tuple(tensors[name].shape)}")
            step, seconds = header["step"], float(header["seconds"])
            if not isinstance(step, int) or not 0 <= step < 2**53:
                raise ValueError(f"its step is {str(step)[:40]}")
            curve = [[int(at), float(rate), float(loss)] for at, rate, loss in header["curve"]]
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise broken(path, f"not a state of this training ({error})") from error
        for name, place in places.items():
            place.copy_(tensors[name])
        for count in (self.step, *self._adam_steps):
            count.fill_(step)
        self.seconds, self.curve = seconds, curve

    def curve_csv(self, batch_size: int) -> str:
        """The loss curve as CSV: step, samples, learning_rate, loss."""
        curve = pd.DataFrame(self.curve, columns=["step", "learning_rate", "loss"])
        curve = curve.astype({"step": int})
        curve.insert(1, "samples", curve["step"] * batch_size)
        return curve.to_csv(index=False, lineterminator="\n")

    def _adam(self, rate: Tensor) -> None:
        """Change the weights by Adam's functional form, whose class loads a compiler for 1.7 s."""
        with torch.no_grad():
            adam(
                self.weights,
                [weight.grad for weight in self.weights],
                *(list(self.means[mean].values()) for mean in ADAM_STATE),
                [],
                self._adam_steps,
                fused=True,
                amsgrad=False,
                beta1=0.9,
                beta2=0.999,
                lr=rate.float(),  # what a GPU takes
                weight_decay=0.0,
                eps=1e-8,
                maximize=False,
            )

    def train_step(
        self,
        batch: LabelledBatch,
        rate: Tensor,
        dtype: torch.dtype,
        chunk: int,
        pool: Executor | None = None,
    ) -> None:
        """One step of Adam on the batch's mean loss.

        Gradients of chunks are computed in the pool's threads and added in the chunks' order,
        so that the result does not depend on the number of threads. Nothing is read back from
        a GPU, which therefore need not be waited for.

        What a network's loss draws depends on the seed, the step and the chunk's number.

        Args:
            rate: of learning, float64 without dimensions.
        """
        count = len(batch.origins)
        chunks = [LabelledBatch(*parts) for parts in zip(*(part.split(chunk) for part in batch))]

        def gradients(number: int, part: LabelledBatch):
            generator = None if self.network.recordable else self._generator(number)
            losses, outputs = self.network.losses(part, self.dead_zone, dtype, generator)
            loss = losses.sum() / count
            return loss.detach(), outputs.detach(), torch.autograd.grad(loss, self.weights)

        compute = pool.map if pool else map
        losses, outputs, parts = zip(*compute(gradients, range(len(chunks)), chunks))
        for weight, *terms in zip(self.weights, *parts):
            weight.grad = terms[0]
            for term in terms[1:]:
                weight.grad += term
        self._adam(rate)
        self.step += 1
        self.loss_sum += torch.stack(losses).sum()
        outputs = torch.cat(outputs)
        if len(outputs):
            low, high = outputs.aminmax()
            self.spread.copy_(high - low)
        else:  # no ray of the batch needed the network: that is not its death
            self.spread.fill_(math.inf)

    def _generator(self, number: int) -> torch.Generator:
        state = np.random.SeedSequence([self.seed, int(self.step), number]).generate_state(
            1, np.uint64
        )
        return torch.Generator(self.step.device).manual_seed(int(state[0]))


def gradient_pool(threads: int) -> ThreadPoolExecutor:
    """Threads that each compute a chunk's gradients alone.

    They meet once a step. Threads inside each matrix product would meet 60 times a step, and
    where another process takes one core away for a moment, all wait for it each time: beside
    one busy process that gave 29,000 samples/s and this gives 70,000 (alone 95,000 and 113,000;
    batches of 16,384 on two cores, in one run).
    """
    return ThreadPoolExecutor(threads, initializer=torch.set_num_threads, initargs=(1,))


def chunk_size(batch_size: int, device: torch.device, most: int) -> int:
    """Rays that one thread takes at once: on a CPU `most`, and no more than half a batch."""
    if device.type == "cuda":
        return batch_size
    return min(most, -(-batch_size // 2))


def may_be_recorded(network: ShadowNetwork, device: torch.device, source: BatchSource) -> bool:
    """Whether a GPU can repeat a step on its own, with the samples that it has."""
    return network.recordable and device.type == "cuda" and isinstance(source, DeviceRays)


def check_alive(name: str, step: int, loss: float, spread: float) -> None:
    """Stop a run that can learn nothing any more.

    Raises:
        InputError: the loss is not finite, or all predictions are the same.
    """
    problem = None
    if not math.isfinite(loss):
        problem = f"the loss is {loss}"
    elif not spread > 0:
        problem = "the network answers the same for every ray (its output died)"
    if problem:
        raise InputError(
            f"training {name}: {problem} at step {step}; lower its `learning_rate` in the "
            "config, or change the `seed`"
        )


def train(
    rays: LabelledRays,
    weights: Path,
    loss_csv: Path,
    record_json: Path,
    *,
    name: str,
    network: dict[str, Any],
    steps: int,
    batch_size: int,
    learning_rate: float,
    schedule: str,
    loss: dict[str, float],
    seed: int,
    mesh_ply: Path | None,
    data: dict[str, Any],
    state_folder: Path,
    state_interval_s: float = 30.0,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Train one network with Adam on its loss, the thesis's on the dead-zone loss [3.5, 4.1].

    Writes the weights, the loss curve and a record of the run (seconds, rate, machine). A
    run that was killed continues from its last saved state when it is called again with the
    same arguments, and on a CPU ends in the same weights as an undisturbed one (a GPU adds the
    gradients of grids in any order).

    Args:
        rays: labelled rays.
        weights, loss_csv, record_json: files to write.
        name: of the experiment, for messages.
        network: what `make_network` makes it from.
        schedule: `constant` or `cosine`.
        loss: weights of `DeadZone`.
        mesh_ply: prepared mesh of the object, for a network that needs it; None for others.
        data: description of the rays (their digests and seeds); goes into the weights' header
            and into the name of the saved state.
        state_folder: where states of trainings live. If this one saved any, that of its end is
            left there, so that nothing is lost with the files that it writes; see `saved_states`.
        state_interval_s: seconds between saved states. A kill costs at most that and one point
            of the loss curve, 1/500 of the run.
        threads: chunks of a batch computed side by side; the weights do not depend on it.

    Raises:
        InputError: the loss is not finite or the output is constant.
    """
    torch.set_num_threads(1)  # the pool's threads work side by side
    chosen = choose_device(device)
    dtype = choose_dtype(precision, chosen)
    settings = {
        "steps": steps,
        "batch_size": batch_size,
        "learning_rate": learning_rate,
        "schedule": schedule,
        "loss": loss,
        "seed": seed,
        "device": chosen.type,
        "precision": str(dtype).removeprefix("torch."),
    }
    header = {"name": name, "network": network, "training": settings, "data": data}

    started = last_saved = time.monotonic()  # what is laid out before training counts too
    model = make_network(network)
    if mesh_ply is not None:
        model.prepare(mesh_ply)
    model.initialise(seed)
    run = TrainingRun(model, chosen, DeadZone(**loss), seed)
    run_folder = Path(state_folder) / f"{name}-{state_digest(header)}"
    state_file = run_folder / "state.safetensors"
    if state_file.exists():
        run.restore(state_file)

    chunk = chunk_size(batch_size, chosen, model.training_chunk)
    source = batch_source(rays, chosen)
    point_interval = max(1, steps // CURVE_POINTS)
    seconds_before = run.seconds
    total = steps * batch_size
    step = saved_step = int(run.step)
    with (
        progress_bar(total, "samples", f"train {name}", step * batch_size) as bar,
        gradient_pool(threads) as pool,
    ):

        def rate_at(step: Tensor) -> Tensor:
            return learning_rate_at(
                step, steps=steps, learning_rate=learning_rate, schedule=schedule
            )

        def advance() -> None:
            indices = batch_indices(run.step, seed=seed, batch_size=batch_size, count=rays.count)
            # A GPU is given its work by one thread, whose stream can be recorded.
            workers = pool if chosen.type == "cpu" else None
            run.train_step(source.gather(indices), rate_at(run.step), dtype, chunk, workers)

        if may_be_recorded(model, chosen, source):
            advance = recorded(advance)
        while step < steps:
            advance()
            step += 1
            bar.update(batch_size)
            # States are saved at points of the curve only, so that a restored run has no
            # half-summed loss to carry along; and only there a GPU is waited for.
            if step % point_interval == 0 or step == steps:
                first_step = run.curve[-1][0] if run.curve else 0
                mean_loss = run.loss_sum.item() / (step - first_step)
                check_alive(name, step, mean_loss, run.spread.item())
                run.curve.append([step, rate_at(run.step - 1).item(), mean_loss])
                run.loss_sum.zero_()
                bar.set_postfix(loss=f"{mean_loss:.4g}", refresh=False)
                run.seconds = seconds_before + time.monotonic() - started
                if time.monotonic() - last_saved > state_interval_s:
                    run.save(state_file)
                    write_text(run_folder / "loss.csv", run.curve_csv(batch_size))
                    last_saved, saved_step = time.monotonic(), step
    if 0 < saved_step < steps:
        run.save(state_file)

    save_network(weights, model, header)
    write_text(loss_csv, run.curve_csv(batch_size))
    write_json(
        record_json,
        {
            **header,
            "parameters": model.parameter_count(),
            "samples": total,
            "seconds": round(run.seconds, 1),
            "samples_per_second": round(total / run.seconds),
            "final_loss": run.curve[-1][2],
            "machine": describe_machine(),
            "threads": threads,
        },
    )
