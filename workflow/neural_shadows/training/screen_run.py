"""A step of a screen-space network's training."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.screen_space.chunk_norm import chunk_statistics
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.training.crop_places import crop_places
from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_crops import Crops, Place
from neural_shadows.training.screen_loss import ScreenLoss, Terms
from neural_shadows.training.training_state import LOSS_SCALE, TrainingState


class ScreenRun(TrainingState):
    """The changing state of one run, and what a step of it does.

    On a CPU each crop is a chunk for one thread of a pool, of networks with batch norms each two, of
    lights of different sizes; on a GPU all are one chunk.

    Args:
        network: with the weights to start from; goes to the device.
        settings: of a training, and `optimiser`, `seed`, `device`, `precision`.
        loss: on the device.
    """

    KEPT = (*TrainingState.KEPT, "validations")

    def __init__(
        self,
        network: ScreenNetwork,
        settings: Mapping[str, Any],
        frames: ScreenFrames,
        loss: ScreenLoss,
    ):
        device = torch.device(settings["device"])
        self.network, self.frames, self.loss = network.to(device), frames, loss
        self.dtype = choose_dtype(settings["precision"], device)
        self.validations: list[Mapping[str, Any]] = []
        side = settings["crop"]
        pixels = settings["crops"] * min(side, frames.height) * min(side, frames.width)
        super().__init__(dict(network.named_parameters()), settings, pixels, network.hidden())
        # Made anew of the weights after each step. Under autocast each crop would: 10 ms of 60.
        self._computing = self.network.in_format(self.dtype)
        self.loss_scale = LOSS_SCALE.get(self.dtype, 1.0)
        self._normed = bool(network.norms())

    def _places(self) -> dict[str, Tensor]:
        return super()._places() | dict(self.network.named_buffers())

    def answer(self, features: Tensor) -> Tensor:
        """Visibility by the network of (B, C, H, W) float32: (B, 1, H, W) float32."""
        return self._computing(features.contiguous(memory_format=torch.channels_last)).float()

    def _learned(self, features: Tensor) -> Tensor:
        """What the loss compares of the same: visibility, or its logarithm."""
        features = features.contiguous(memory_format=torch.channels_last)
        return self._computing.learned(features).float()

    def _round_weights(self) -> None:
        """Bring the computing copy to the weights, and to the norms' running statistics."""
        with torch.no_grad():
            for rounded, weight in zip(self._computing.parameters(), self.weights.values()):
                rounded.copy_(weight)
            for copied, own in zip(self._computing.buffers(), self.network.buffers()):
                copied.copy_(own)

    def restore(self, path: Path) -> None:
        super().restore(path)
        self._round_weights()

    def train_step(self, step: int, pool: Executor) -> None:
        """Do the step of this number; its crops are gathered and their gradients made in the pool.

        Raises:
            InputError: a crop holds NaN or infinity.
        """
        chunks, count = self._gathered(step, pool)
        weights = list(self._computing.parameters())

        def gradients(crops: Crops):
            with chunk_statistics() as seen:
                output = self._learned(crops.features)
            twin = None if crops.twin is None else self._twin(crops)
            aim = self._computing.aim(crops.target)
            loss = self.loss(output, aim, crops.valid, count, twin, crops.twin_valid)
            parts = torch.autograd.grad(self.loss_scale * loss, weights)
            return (loss.detach(), output.detach().flatten(), parts), seen

        compute = self._compute(pool)
        found, seen = zip(*compute(gradients, chunks))
        self.change_weights(*zip(*found), compute)
        if self._normed:
            self.network.update_norms(seen)
        self._round_weights()

    def _twin(self, crops: Crops) -> Tensor:
        """`_learned` of twins, by the norms' running statistics, where they are compared."""
        with torch.no_grad():
            answer = self._learned(crops.twin)
        if crops.twin_at is None:
            return answer
        return answer.flatten(1).gather(1, crops.twin_at.flatten(1)).view_as(answer)

    def first_terms(self, pool: Executor) -> Terms:
        """The terms of the first step's loss against the targets, with the weights as they are."""
        chunks, count = self._gathered(0, pool)

        def terms(crops: Crops) -> Terms:
            with torch.no_grad(), chunk_statistics():
                output = self._learned(crops.features)
                others = [(self._computing.aim(crops.target), crops.valid)]
                (found,) = self.loss.terms(output, crops.valid, others, count)
            return found

        found = zip(*self._compute(pool)(terms, chunks))
        return Terms(*(torch.stack(one).sum() for one in found))

    def _compute(self, pool: Executor) -> Callable:
        return pool.map if self.device.type == "cpu" else map  # a GPU is given work by one thread

    def _gathered(self, step: int, pool: Executor) -> tuple[Sequence[Crops], int]:
        """The chunks of a step, and how many of its pixels are valid."""
        settings = self.settings
        late = step >= settings["perturbation_from"] * settings["steps"]
        twins = settings["perturbation"] > 0 and late
        drawn = {key: settings[key] for key in ("seed", "crops", "crop", "flips")}
        drawn["lights"] = settings.get("lights")

        def crop(place: Place) -> Crops:
            return self.frames.crop(place, settings["crop"], settings["aligned"])

        places = crop_places(self.frames, step, twins=twins, pairs=self._normed, **drawn)
        crops = list(pool.map(crop, places))
        count = max(sum(int(one.valid.sum()) for one in crops), 1)
        if self.device.type == "cpu":
            size = 2 if self._normed else 1
            chunks = (crops[first : first + size] for first in range(0, len(crops), size))
            return [Crops.joined(chunk) for chunk in chunks], count
        return [Crops.joined(crops).to(self.device)], count
