"""Optimisers: Adam, or Muon for hidden layers and Adam elsewhere.

`torch.optim.Adam` and `torch.optim.Muon` compute the same (Adam to the bit), but their first step
loads torch's compiler, 1.7 to 2.5 s in each training job, and their bookkeeping takes 0.1 to 0.5 ms
a step.
"""

import re
from collections.abc import Callable, Collection, Mapping

import torch
from torch import Tensor
from torch.optim.adam import adam

from neural_shadows.errors import InputError
from neural_shadows.networks.compute import choose_dtype
from neural_shadows.settings.records import TrainingSettings

# Matrices between two layers of neurons: all `layers` but the first, behind encoding or grids.
_HIDDEN = re.compile(r"layers\.[1-9]\d*(\.weight)?")


class Adam:
    """Adam (Kingma and Ba 2015) on some weights, by name; the thesis's optimiser [4.1]."""

    def __init__(self, weights: Mapping[str, Tensor]):
        self._weights = list(weights.values())
        self._means = {
            mean: {name: torch.zeros_like(weight) for name, weight in weights.items()}
            for mean in ("exp_avg", "exp_avg_sq")
        }
        # Adam counts steps for each weight.
        self._steps = [torch.zeros((), device=weight.device) for weight in self._weights]

    def state(self) -> dict[str, Tensor]:
        """Tensors by their names in a checkpoint."""
        return {
            f"{mean}.{name}": value
            for mean, values in self._means.items()
            for name, value in values.items()
        }

    def continue_at(self, step: int) -> None:
        """Continue counting from a step."""
        for count in self._steps:
            count.fill_(step)

    def step(self, rate: Tensor, compute: Callable = map) -> None:
        """Change the weights by their gradients; `rate` is a scalar on their device."""
        with torch.no_grad():
            adam(
                self._weights,
                [weight.grad for weight in self._weights],
                *(list(values.values()) for values in self._means.values()),
                [],
                self._steps,
                fused=True,
                amsgrad=False,
                beta1=0.9,
                beta2=0.999,
                lr=rate.float(),  # required on a GPU
                weight_decay=0.0,
                eps=1e-8,
                maximize=False,
            )


class Muon:
    """Muon (Jordan 2024) on matrices, by name: steps along the orthogonalised momentum.

    With torch's constants and no weight decay. Kernels of convolutions are matrices with a row an
    output, of transposed ones an input. On coordinate networks it was better than Adam by up to 9 dB with Adam on the first and
    last layers (arXiv 2512.14366); on Neural Shadow Mapping 400 steps end at two thirds of the
    error of 800 steps of Adam.

    Args:
        dtype: of the products. torch's are bfloat16, emulated where it is not native: 0.95 s of a
            step of Neural Shadow Mapping with AVX2, 0.07 s in float32.
    """

    def __init__(self, weights: Mapping[str, Tensor], dtype: torch.dtype):
        self._weights, self._dtype = dict(weights), dtype
        self._momentum = {name: torch.zeros_like(weight) for name, weight in weights.items()}

    def state(self) -> dict[str, Tensor]:
        """Tensors by their names in a checkpoint."""
        return {f"momentum.{name}": value for name, value in self._momentum.items()}

    def continue_at(self, step: int) -> None:
        """Do nothing: Muon counts no steps."""

    def step(self, rate: Tensor, compute: Callable = map) -> None:
        """Change the weights by their gradients; `rate` is a scalar on their device.

        Args:
            compute: `map`, or that of a pool whose threads then share the matrices.
        """
        rate = rate.float()
        list(compute(lambda name: self._move(name, rate), self._weights))

    def _move(self, name: str, rate: Tensor) -> None:
        weight = self._weights[name]
        with torch.no_grad():  # not inherited by a pool's threads
            gradient, momentum = (
                matrix.view(len(matrix), -1) for matrix in (weight.grad, self._momentum[name])
            )
            momentum.lerp_(gradient, 0.05)
            direction = orthogonalised(gradient.lerp(momentum, 0.95), self._dtype)
            rows, columns = direction.shape
            unit_step = direction.to(weight.dtype) * -(max(1, rows / columns) ** 0.5)
            weight += rate * unit_step.view_as(weight)


def orthogonalised(matrix: Tensor, dtype: torch.dtype) -> Tensor:
    """Singular values to about 1: five Newton-Schulz iterations (Jordan 2024).

    Args:
        dtype: of the products and the result.
    """
    wide = matrix.T if len(matrix) > matrix.shape[1] else matrix
    x = wide.to(dtype)
    x = x / x.norm().clamp(min=1e-7)
    for _ in range(5):
        squares = x @ x.T
        x = torch.addmm(
            x, torch.addmm(squares, squares, squares, beta=-4.7750, alpha=2.0315), x, beta=3.4445
        )
    return x if wide is matrix else x.T


def make_optimisers(
    weights: Mapping[str, Tensor],
    settings: TrainingSettings,
    hidden: Collection[str] | None = None,
) -> dict[str, Adam | Muon]:
    """Optimisers of a training's weights, by key of their rate.

    Args:
        settings: `optimiser`: `adam`, or `muon` with an `adam_rate` for other than hidden layers;
            `precision` and `device`.
        hidden: names of hidden layers; by default all `layers` but the first.

    Raises:
        InputError: `muon` without hidden layers.
    """
    if settings["optimiser"] == "adam":
        return {"learning_rate": Adam(weights)}
    if hidden is None:
        hidden = [name for name in weights if _HIDDEN.fullmatch(name)]
    if not hidden:
        raise InputError("optimiser: muon: the network has no hidden layers. Set optimiser: adam.")
    inner = {name: weights[name] for name in hidden}
    others = {name: weight for name, weight in weights.items() if name not in inner}
    dtype = choose_dtype(settings["precision"], torch.device(settings["device"]))
    muon = Muon(inner, torch.float32 if dtype == torch.float32 else torch.bfloat16)
    return {"learning_rate": muon, "adam_rate": Adam(others)}
