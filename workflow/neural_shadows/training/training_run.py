"""The state of one training, and a step of it."""

import math
from concurrent.futures import Executor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import torch
from torch import Tensor
from torch.optim.adam import adam

from neural_shadows.files.broken import broken
from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.shadow_network import LabelledBatch, ShadowNetwork
from neural_shadows.networks.weight_file import load_tensors, save_tensors

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
