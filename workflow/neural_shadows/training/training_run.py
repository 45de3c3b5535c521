"""A step of a shadow network's training on labelled rays."""

import numpy as np
import torch

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.shadow_network import LabelledBatch, ShadowNetwork
from neural_shadows.settings.records import TrainingSettings
from neural_shadows.training.training_state import LOSS_SCALE, TrainingState
from neural_shadows.training.workers import Workers


class TrainingRun(TrainingState):
    """State and step of one training on rays.

    Args:
        network: with the weights to start from; goes to the device.
        settings: as in a weight file's header: `optimiser` and its rates, `steps`, `batch_size`,
            `schedule`, `loss`, `seed`, `device` and `precision`.

    Raises:
        InputError: an optimiser unfit for this network.
    """

    def __init__(self, network: ShadowNetwork, settings: TrainingSettings):
        device = torch.device(settings["device"])
        self.network, self.dead_zone = network.to(device), DeadZone(**settings["loss"])
        self.dtype = choose_dtype(settings["precision"], device)
        self.chunk = settings["batch_size"]  # rays of a thread at once
        if device.type == "cpu":
            self.chunk = min(network.training_chunk, -(-self.chunk // 2))
        self.chunks = -(-settings["batch_size"] // self.chunk)
        super().__init__(dict(network.named_parameters()), settings, settings["batch_size"])
        self.loss_scale = LOSS_SCALE.get(self.dtype, 1.0)

    def train_step(self, batch: LabelledBatch, workers: Workers | None = None) -> None:
        """Do one step on the batch's mean loss.

        Gradients of chunks are computed side by side and added in the chunks' order, so
        that the result is independent of the number of threads. Nothing is read back from a
        GPU, except the number of the step for a network that draws random numbers.
        Random numbers of a network's loss are determined by the seed, the step and the chunk's
        number.
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

        compute = workers.map if workers else map
        losses, outputs, parts = zip(*compute(gradients, range(len(chunks)), chunks))
        self.change_weights(losses, outputs, parts, compute)

    def _generator(self, number: int) -> torch.Generator:
        state = np.random.SeedSequence([self.settings["seed"], int(self.step), number])
        seed = int(state.generate_state(1, np.uint64)[0])
        return torch.Generator(self.device).manual_seed(seed)
