"""Step of a screen-space network's training."""

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.screen_space.chunk_norm import chunk_statistics
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.settings.records import TrainingSettings
from neural_shadows.training.crop_samples import crop_samples
from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_crops import Crops, CropSample
from neural_shadows.training.screen_loss import ScreenLoss, Terms
from neural_shadows.training.training_state import LOSS_SCALE, TrainingState
from neural_shadows.training.workers import Workers


class ScreenRun(TrainingState):
    """State and step of one screen-space training.

    On a CPU each crop is a chunk for one thread, or with batch norms each two, with
    lights of different sizes; on a GPU all are one chunk.

    Args:
        network: with the weights to start from; goes to the device.
        settings: of a training, and `optimiser`, `seed`, `device`, `precision`.
        loss: on the device.
    """

    HEADER = (*TrainingState.HEADER, "validations")

    def __init__(
        self,
        network: ScreenNetwork,
        settings: TrainingSettings,
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
        # Updated after each step. Autocast would convert for each crop: 10 ms of 60.
        self._working_copy = self.network.in_format(self.dtype)
        self.loss_scale = LOSS_SCALE.get(self.dtype, 1.0)
        self._has_norms = bool(network.norms())

    def _tensors(self) -> dict[str, Tensor]:
        return super()._tensors() | dict(self.network.named_buffers())

    def predict(self, features: Tensor) -> Tensor:
        """Predict visibility (B, 1, H, W) float32 of (B, C, H, W) float32."""
        return self._working_copy(features.contiguous(memory_format=torch.channels_last)).float()

    def _loss_input(self, features: Tensor) -> Tensor:
        """Visibility or its logarithm, as compared by the loss."""
        features = features.contiguous(memory_format=torch.channels_last)
        return self._working_copy.loss_input(features).float()

    def _round_weights(self) -> None:
        """Update the working copy from weights and running statistics."""
        with torch.no_grad():
            for rounded, weight in zip(self._working_copy.parameters(), self.weights.values()):
                rounded.copy_(weight)
            for copied, buffer in zip(self._working_copy.buffers(), self.network.buffers()):
                copied.copy_(buffer)

    def restore(self, path: Path) -> None:
        super().restore(path)
        self._round_weights()

    def train_step(self, step: int, workers: Workers) -> None:
        """Do a step; crops and gradients are computed side by side.

        Raises:
            InputError: a crop with NaN or infinity.
        """
        chunks, count = self._gather(step, workers)
        weights = list(self._working_copy.parameters())

        def gradients(crops: Crops):
            with chunk_statistics() as statistics:
                output = self._loss_input(crops.features)
            twin = None if crops.twin is None else self._perturbed(crops)
            target = self._working_copy.loss_target(crops.target)
            loss = self.loss(output, target, crops.valid, count, twin, crops.twin_valid)
            parts = torch.autograd.grad(self.loss_scale * loss, weights)
            return (loss.detach(), output.detach().flatten(), parts), statistics

        compute = self._compute(workers)
        results, statistics = zip(*compute(gradients, chunks))
        self.change_weights(*zip(*results), compute)
        if self.network.of_its_base:  # crops that are lit everywhere are no divergence
            self.spread.fill_(math.inf)
        if self._has_norms:
            self.network.update_norms(statistics)
        self._round_weights()

    def _perturbed(self, crops: Crops) -> Tensor:
        """`_loss_input` of perturbed frames by running statistics, aligned."""
        with torch.no_grad():
            output = self._loss_input(crops.twin)
        if crops.twin_at is None:
            return output
        return output.flatten(1).gather(1, crops.twin_at.flatten(1)).view_as(output)

    def first_terms(self, workers: Workers) -> Terms:
        """Loss terms of the first step with the present weights."""
        chunks, count = self._gather(0, workers)

        def chunk_terms(crops: Crops) -> Terms:
            with torch.no_grad(), chunk_statistics():
                output = self._loss_input(crops.features)
                others = [(self._working_copy.loss_target(crops.target), crops.valid)]
                (terms,) = self.loss.terms(output, crops.valid, others, count)
            return terms

        shares = zip(*self._compute(workers)(chunk_terms, chunks))
        return Terms(*(torch.stack(share).sum() for share in shares))

    def _compute(self, workers: Workers) -> Callable:
        return workers.map if self.device.type == "cpu" else map  # one thread feeds a GPU

    def _gather(self, step: int, workers: Workers) -> tuple[Sequence[Crops], int]:
        """Chunks of a step, and its number of valid pixels."""
        settings = self.settings
        late = step >= settings["perturbation_from"] * settings["steps"]
        twins = settings["perturbation"] > 0 and late
        sampling = {key: settings[key] for key in ("seed", "crops", "crop", "flips")}
        sampling["lights"] = settings.get("lights")

        def crop(sample: CropSample) -> Crops:
            return self.frames.crop(sample, settings["crop"], settings["aligned"])

        samples = crop_samples(self.frames, step, twins=twins, pairs=self._has_norms, **sampling)
        crops = list(workers.map(crop, samples))
        count = max(sum(int(each.valid.sum()) for each in crops), 1)
        if self.device.type == "cpu":
            size = 2 if self._has_norms else 1
            chunks = (crops[first : first + size] for first in range(0, len(crops), size))
            return [Crops.joined(chunk) for chunk in chunks], count
        return [Crops.joined(crops).to(self.device)], count
