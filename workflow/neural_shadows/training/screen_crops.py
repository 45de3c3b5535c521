"""A crop of a frame: position, and tensors for a network."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import torch
from torch import Tensor


@dataclass(frozen=True)
class CropSample:
    """A crop of a frame, radius and perturbed frame."""

    frame: int
    radius: int
    twin: int  # perturbed frame, from 1; 0 for none
    top: int
    left: int
    upside_down: bool
    mirrored: bool


class Crops(NamedTuple):
    """B crops for a network.

    Features (B, C, h, w) float32, of a perturbed frame (`twin`) too if requested; target (B, 1, h,
    w) float32; valid pixels, (B, 1, h, w) bool.

    If aligned, `twin_at` (B, 1, h, w) int64 is the perturbed frame's pixel, row · w + column, of
    the same surface point, and `twin_valid` its mask; else both are of the pixel at the same
    position.
    """

    features: Tensor
    target: Tensor
    valid: Tensor
    twin: Tensor | None
    twin_valid: Tensor | None
    twin_at: Tensor | None

    @staticmethod
    def joined(crops: Sequence["Crops"]) -> "Crops":
        """Concatenate crops to one chunk."""
        parts = zip(*crops)
        return Crops(*(torch.cat(part) if part[0] is not None else None for part in parts))

    def to(self, device: torch.device) -> "Crops":
        """Move to a device."""
        return Crops(*(part if part is None else part.to(device) for part in self))
