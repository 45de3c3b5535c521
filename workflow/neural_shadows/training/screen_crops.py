"""A crop: where it lies, and what a network is given of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import torch
from torch import Tensor


@dataclass(frozen=True)
class Place:
    """Which crop: of a frame, a radius and a twin, and where it lies in the frame."""

    frame: int
    radius: int
    twin: int  # from 1; 0 where none is wanted
    top: int
    left: int
    upside_down: bool
    mirrored: bool


class Crops(NamedTuple):
    """B crops: features (B, C, h, w) float32, of a twin too if one is wanted; target (B, 1, h, w)
    float32; which pixels count, (B, 1, h, w) bool.

    If twins are aligned, `twin_at` (B, 1, h, w) int64 is the twin's pixel, row · w + column, that shows
    what each pixel does, and `twin_valid` is of that pixel; else both are of the pixel in its place.
    """

    features: Tensor
    target: Tensor
    valid: Tensor
    twin: Tensor | None
    twin_valid: Tensor | None
    twin_at: Tensor | None

    @staticmethod
    def joined(crops: Sequence["Crops"]) -> "Crops":
        """Some crops as one chunk."""
        parts = zip(*crops)
        return Crops(*(torch.cat(one) if one[0] is not None else None for one in parts))

    def to(self, device: torch.device) -> "Crops":
        """The same on a device."""
        return Crops(*(one if one is None else one.to(device) for one in self))
