"""The state of one training, and a step of it."""

import math
from collections.abc import Mapping
from concurrent.futures import Executor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import torch
from torch import Tensor

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.shadow_network import LabelledBatch, ShadowNetwork
from neural_shadows.networks.weight_file import load_tensors, save_tensors
from neural_shadows.training.optimisers import make_optimisers

# Losses are multiplied by it before the backward pass and gradients divided by it after: float16
# ends at 6e-8, which the gradients of a mean over 65,536 samples reach. That of tiny-cuda-nn.
LOSS_SCALE = {torch.float16: 128.0}


def learning_rate_at(
    step: Tensor, settings: Mapping[str, Any], key: str = "learning_rate"
) -> Tensor:
    """A rate of a step: `constant`, or `cosine` from the setting's down to zero.

    Without dimensions, in float64, on the step's device: a recorded step needs it there.
    """
    rate = torch.full_like(step, settings[key], dtype=torch.float64)
    if settings["schedule"] == "cosine":
        rate = rate * 0.5 * (1 + torch.cos(math.pi * step.double() / settings["steps"]))
    return rate


class TrainingRun:
    """The changing state of one run: weights, optimisers, step, loss curve, seconds.

    Args:
        network: with the weights to start from; goes to the device.
        settings: as in a weight file's header: `optimiser` and its rates, `steps`, `batch_size`,
            `schedule`, `loss`, `seed`, `device` and `precision`.

    Raises:
        InputError: an optimiser that is not for this network.
    """

    def __init__(self, network: ShadowNetwork, settings: Mapping[str, Any]):
        self.settings, self.device = settings, torch.device(settings["device"])
        self.network, self.dead_zone = network.to(self.device), DeadZone(**settings["loss"])
        self.dtype = choose_dtype(settings["precision"], self.device)
        self.chunk = settings["batch_size"]  # rays that one thread takes at once
        if self.device.type == "cpu":
            self.chunk = min(network.training_chunk, -(-self.chunk // 2))
        self.weights = dict(network.named_parameters())
        self.step = torch.zeros((), dtype=torch.int64, device=self.device)
        self.loss_sum = torch.zeros((), device=self.device)  # of the steps since the last point
        self.spread = torch.zeros((), device=self.device)  # max − min of the last step's outputs
        self.seconds = 0.0
        self.curve: list[list[float]] = []  # [step, learning rate, mean loss since the last]
        # Of the first point at which the loss was not finite, or all outputs were the same.
        self.died_at_step: int | None = None
        self.loss_scale = LOSS_SCALE.get(self.dtype, 1.0)
        self.optimisers = make_optimisers(self.weights, settings)

    def _places(self) -> dict[str, Tensor]:
        """All tensors of the state, by their names in a checkpoint."""
        places = {name: weight.data for name, weight in self.weights.items()}
        for optimiser in self.optimisers.values():
            places |= optimiser.state()
        return places

    def save(self, path: Path) -> None:
        """Write the whole state."""
        header = {"step": int(self.step), "seconds": self.seconds, "curve": self.curve}
        header["died_at_step"] = self.died_at_step
        save_tensors(path, self._places(), header)

    def restore(self, path: Path) -> None:
        """Continue from a state that `save` wrote; InputError if the file is damaged."""
        tensors, header = load_tensors(path)
        for name, place in self._places().items():
            place.copy_(tensors[name])
        self.step.fill_(header["step"])
        for optimiser in self.optimisers.values():
            optimiser.continue_at(header["step"])
        self.seconds, self.curve = header["seconds"], header["curve"]
        self.died_at_step = header["died_at_step"]

    def add_point(self) -> None:
        """A point of the loss curve: the mean loss of the steps since the point before.

        A run whose loss is no number, or that answers the same for every ray, can learn nothing
        any more: it has died.
        """
        step, before = int(self.step), self.curve[-1][0] if self.curve else 0
        mean_loss = self.loss_sum.item() / (step - before)
        rate = learning_rate_at(self.step - 1, self.settings).item()
        self.curve.append([step, rate, mean_loss])
        self.loss_sum.zero_()
        if not (math.isfinite(mean_loss) and self.spread.item() > 0):
            self.died_at_step = step

    def curve_csv(self) -> str:
        """The loss curve as CSV: step, samples, learning_rate, loss."""
        curve = pd.DataFrame(self.curve, columns=["step", "learning_rate", "loss"])
        curve.insert(1, "samples", curve["step"] * self.settings["batch_size"])
        return curve.to_csv(index=False, lineterminator="\n")

    def train_step(self, batch: LabelledBatch, pool: Executor | None = None) -> None:
        """One step on the batch's mean loss.

        Gradients of chunks are computed in the pool's threads and added in the chunks' order,
        so that the result does not depend on the number of threads. Nothing is read back from
        a GPU, which therefore need not be waited for.

        What a network's loss draws depends on the seed, the step and the chunk's number.
        """
        count = len(batch.origins)
        weights = list(self.weights.values())
        chunks = [LabelledBatch(*parts) for parts in zip(*(p.split(self.chunk) for p in batch))]

        def gradients(number: int, part: LabelledBatch):
            generator = None if self.network.recordable else self._generator(number)
            losses, outputs = self.network.losses(part, self.dead_zone, self.dtype, generator)
            loss = losses.sum() / count
            parts = torch.autograd.grad(self.loss_scale * loss, weights)
            return loss.detach(), outputs.detach(), parts

        compute = pool.map if pool else map
        losses, outputs, parts = zip(*compute(gradients, range(len(chunks)), chunks))
        for weight, *terms in zip(weights, *parts):
            weight.grad = terms[0]
            for term in terms[1:]:
                weight.grad += term
            if self.loss_scale != 1:
                weight.grad /= self.loss_scale
        for key, optimiser in self.optimisers.items():
            optimiser.step(learning_rate_at(self.step, self.settings, key), compute)
        self.step += 1
        self.loss_sum += torch.stack(losses).sum()
        outputs = torch.cat(outputs)
        if len(outputs):
            low, high = outputs.aminmax()
            self.spread.copy_(high - low)
        else:  # no ray of the batch needed the network: that is not its death
            self.spread.fill_(math.inf)

    def _generator(self, number: int) -> torch.Generator:
        state = np.random.SeedSequence([self.settings["seed"], int(self.step), number])
        seed = int(state.generate_state(1, np.uint64)[0])
        return torch.Generator(self.device).manual_seed(seed)


def gradient_pool(threads: int) -> ThreadPoolExecutor:
    """Threads that each compute a chunk's gradients alone.

    They meet once a step. Threads inside each matrix product would meet 60 times, and all wait
    where another process takes a core for a moment: beside one busy process that gave 29,000
    samples/s and this gives 70,000 (batches of 16,384 on two cores).
    """
    return ThreadPoolExecutor(threads, initializer=torch.set_num_threads, initargs=(1,))
