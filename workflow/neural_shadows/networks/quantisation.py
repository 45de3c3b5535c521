"""Quantisation of weights for weight files."""

import torch
from torch import Tensor

SCALE = ".scale"  # suffix of the name of an int8 tensor's scale
_DTYPES = {"float32": torch.float32, "float16": torch.float16}


def quantise(tensors: dict[str, Tensor], storage: str) -> dict[str, Tensor]:
    """Convert tensors: `float32`, `float16`, or `int8` with one scale each, the maximum / 127."""
    if storage != "int8":
        return {name: value.to(_DTYPES[storage]) for name, value in tensors.items()}
    stored = {}
    for name, value in tensors.items():
        scale = value.abs().amax().clamp(min=1e-12).float() / 127
        stored[name] = (value / scale).round().to(torch.int8)
        stored[name + SCALE] = scale.reshape(1)
    return stored


def restore_values(stored: dict[str, Tensor], storage: str) -> dict[str, Tensor]:
    """float32 tensors from those of `quantise`."""
    if storage != "int8":
        return {name: value.float() for name, value in stored.items()}
    names = [name for name in stored if not name.endswith(SCALE)]
    return {name: stored[name].float() * stored[name + SCALE] for name in names}
