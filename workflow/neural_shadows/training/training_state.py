"""State of a training, common to all networks."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
import torch
from torch import Tensor

from neural_shadows.networks.weight_file import load_tensors, save_tensors
from neural_shadows.settings.records import TrainingSettings
from neural_shadows.training.optimisers import make_optimisers

# Losses are multiplied by it before the backward pass and gradients divided by it after: float16's
# minimum, 6e-8, is the size of gradients of a mean over 65,536 samples. As in tiny-cuda-nn.
LOSS_SCALE = {torch.float16: 128.0}


def learning_rate_at(
    step: Tensor, settings: TrainingSettings, key: str = "learning_rate"
) -> Tensor:
    """Learning rate of a step.

    `constant`; `cosine` from the setting's down to zero; or `steps`: a tenth from each of
    `tenth_from` on.

    Without dimensions, in float64, on the step's device for recorded steps.
    """
    rate = torch.full_like(step, settings[key], dtype=torch.float64)
    match settings["schedule"]:
        case "cosine":
            rate = rate * 0.5 * (1 + torch.cos(math.pi * step.double() / settings["steps"]))
        case "steps":
            for start in settings["tenth_from"]:
                rate = torch.where(step >= start, rate / 10, rate)
    return rate


class TrainingState:
    """State of one training: weights, optimisers, step, loss curve, seconds.

    Args:
        weights: by name, on the device; changed by the training.
        settings: `optimiser` and its rates, `steps` and `schedule`.
        samples_a_step: rays or pixels of a step.
        hidden: see `make_optimisers`.

    Raises:
        InputError: an optimiser unfit for this network.
    """

    HEADER = ("seconds", "curve", "died_at_step")  # of a checkpoint, beside the step

    def __init__(
        self,
        weights: Mapping[str, Tensor],
        settings: TrainingSettings,
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
        # First point with a loss that is not finite, or with the same output everywhere.
        self.died_at_step: int | None = None
        self.loss_scale = 1.0
        self.optimisers = make_optimisers(self.weights, settings, hidden)

    def _tensors(self) -> dict[str, Tensor]:
        """Tensors of the state, by their names in a checkpoint."""
        tensors = {name: weight.data for name, weight in self.weights.items()}
        for optimiser in self.optimisers.values():
            tensors |= optimiser.state()
        return tensors

    def save(self, path: Path) -> None:
        """Write the whole state."""
        header = {"step": int(self.step), **{name: getattr(self, name) for name in self.HEADER}}
        save_tensors(path, self._tensors(), header)

    def restore(self, path: Path) -> None:
        """Continue from a state of `save`; InputError for a damaged file."""
        tensors, header = load_tensors(path)
        for name, tensor in self._tensors().items():
            tensor.copy_(tensors[name])
        self.step.fill_(header["step"])
        for optimiser in self.optimisers.values():
            optimiser.continue_at(header["step"])
        for name in self.HEADER:
            setattr(self, name, header[name])

    def add_point(self) -> None:
        """Add a loss-curve point: the mean loss since the one before.

        A run with a loss that is not finite, or with the same output everywhere, has diverged.
        """
        step, before = int(self.step), self.curve[-1][0] if self.curve else 0
        mean_loss = self.loss_sum.item() / (step - before)
        rate = learning_rate_at(self.step - 1, self.settings).item()
        self.curve.append([step, rate, mean_loss])
        self.loss_sum.zero_()
        if not (math.isfinite(mean_loss) and self.spread.item() > 0):
            self.died_at_step = step

    def outcome(self) -> dict[str, Any]:
        """Samples, seconds, samples a second and final loss, for training.json."""
        samples, final_loss = int(self.step) * self.samples_a_step, self.curve[-1][2]
        return {
            "samples": samples,
            "seconds": round(self.seconds, 1),
            "samples_per_second": round(samples / self.seconds),
            "final_loss": final_loss if math.isfinite(final_loss) else None,
        }

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
        """End a step with its chunks' results, added in order.

        Args:
            losses: each chunk's share of the step's loss; outputs: its predictions.
            gradients: each chunk's by weight, times `loss_scale`.
            compute: `map`, or a pool's.
        """
        for weight, *terms in zip(self.weights.values(), *gradients):
            # Optimisers traverse a weight and its gradient in memory order.
            weight.grad = terms[0].to(weight.dtype).contiguous()
            for term in terms[1:]:
                weight.grad += term
            if self.loss_scale != 1:
                weight.grad /= self.loss_scale
        for key, optimiser in self.optimisers.items():
            optimiser.step(learning_rate_at(self.step, self.settings, key), compute)
        self.step += 1
        self.loss_sum += torch.stack([*losses]).sum()
        values = torch.cat([*outputs])
        if len(values):
            low, high = values.aminmax()
            self.spread.copy_(high - low)
        else:  # no ray of the batch needed the network: not a divergence
            self.spread.fill_(math.inf)
