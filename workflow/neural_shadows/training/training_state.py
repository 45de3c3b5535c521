"""The state of a training: what each kind of network has that is trained here."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pandas as pd
import torch
from torch import Tensor

from neural_shadows.networks.weight_file import load_tensors, save_tensors
from neural_shadows.training.optimisers import make_optimisers

# Losses are multiplied by it before the backward pass and gradients divided by it after: float16
# ends at 6e-8, which the gradients of a mean over 65,536 samples reach. That of tiny-cuda-nn.
LOSS_SCALE = {torch.float16: 128.0}


def learning_rate_at(
    step: Tensor, settings: Mapping[str, Any], key: str = "learning_rate"
) -> Tensor:
    """A rate of a step: `constant`, `cosine` from the setting's down to zero, or by `steps` a tenth of
    that before from each of `tenth_from` on.

    Without dimensions, in float64, on the step's device: a recorded step needs it there.
    """
    rate = torch.full_like(step, settings[key], dtype=torch.float64)
    match settings["schedule"]:
        case "cosine":
            rate = rate * 0.5 * (1 + torch.cos(math.pi * step.double() / settings["steps"]))
        case "steps":
            for place in settings["tenth_from"]:
                rate = torch.where(step >= place, rate / 10, rate)
    return rate


class TrainingState:
    """The changing state of one training: weights, optimisers, step, loss curve, seconds.

    Args:
        weights: by name, on the device; what the training changes.
        settings: `optimiser` and its rates, `steps` and `schedule`.
        samples_a_step: how many rays or pixels a step has.
        hidden: see `make_optimisers`.

    Raises:
        InputError: an optimiser that is not for this network.
    """

    KEPT = ("seconds", "curve", "died_at_step")  # in a checkpoint's header, beside the step

    def __init__(
        self,
        weights: Mapping[str, Tensor],
        settings: Mapping[str, Any],
        samples_a_step: int,
        hidden: Collection[str] | None = None,
    ):
        self.weights, self.settings = dict(weights), settings
        self.samples_a_step = samples_a_step
        self.device = torch.device(settings["device"])
        self.step = torch.zeros((), dtype=torch.int64, device=self.device)
        self.loss_sum = torch.zeros((), device=self.device)  # of the steps since the last point
        self.spread = torch.zeros((), device=self.device)  # max − min of the last step's outputs
        self.seconds = 0.0
        self.curve: list[list[float]] = []  # [step, learning rate, mean loss since the last]
        # Of the first point at which the loss was not finite, or all outputs were the same.
        self.died_at_step: int | None = None
        self.loss_scale = 1.0
        self.optimisers = make_optimisers(self.weights, settings, hidden)

    def _places(self) -> dict[str, Tensor]:
        """All tensors of the state, by their names in a checkpoint."""
        places = {name: weight.data for name, weight in self.weights.items()}
        for optimiser in self.optimisers.values():
            places |= optimiser.state()
        return places

    def save(self, path: Path) -> None:
        """Write the whole state."""
        header = {"step": int(self.step), **{name: getattr(self, name) for name in self.KEPT}}
        save_tensors(path, self._places(), header)

    def restore(self, path: Path) -> None:
        """Continue from a state that `save` wrote; InputError if the file is damaged."""
        tensors, header = load_tensors(path)
        for name, place in self._places().items():
            place.copy_(tensors[name])
        self.step.fill_(header["step"])
        for optimiser in self.optimisers.values():
            optimiser.continue_at(header["step"])
        for name in self.KEPT:
            setattr(self, name, header[name])

    def add_point(self) -> None:
        """A point of the loss curve: the mean loss of the steps since the point before.

        A run whose loss is no number, or that answers the same to everything, can learn nothing
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
        curve.insert(1, "samples", curve["step"] * self.samples_a_step)
        return curve.to_csv(index=False, lineterminator="\n")

    def change_weights(
        self,
        losses: Sequence[Tensor],
        outputs: Sequence[Tensor],
        gradients: Sequence[Sequence[Tensor]],
        compute: Callable = map,
    ) -> None:
        """End a step with what its chunks gave, added in their order.

        Args:
            losses: each chunk's share of the step's loss; outputs: its answers.
            gradients: each chunk's by weight, times `loss_scale`.
            compute: `map`, or that of a pool whose threads share the work.
        """
        for weight, *terms in zip(self.weights.values(), *gradients):
            # An optimiser goes through a weight and its gradient by their places in memory.
            weight.grad = terms[0].to(weight.dtype).contiguous()
            for term in terms[1:]:
                weight.grad += term
            if self.loss_scale != 1:
                weight.grad /= self.loss_scale
        for key, optimiser in self.optimisers.items():
            optimiser.step(learning_rate_at(self.step, self.settings, key), compute)
        self.step += 1
        self.loss_sum += torch.stack([*losses]).sum()
        answers = torch.cat([*outputs])
        if len(answers):
            low, high = answers.aminmax()
            self.spread.copy_(high - low)
        else:  # nothing of the batch needed the network: that is not its death
            self.spread.fill_(math.inf)


def gradient_pool(threads: int) -> ThreadPoolExecutor:
    """Threads that each compute a chunk's gradients alone.

    They meet once a step. Threads inside each matrix product would meet 60 times, and all wait
    where another process takes a core for a moment: beside one busy process that gave 29,000
    samples/s and this gives 70,000 (batches of 16,384 on two cores).
    """
    return ThreadPoolExecutor(threads, initializer=torch.set_num_threads, initargs=(1,))
