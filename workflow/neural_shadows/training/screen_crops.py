"""The crops of a step: which are drawn, and what a network is given of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import torch
from torch import Tensor

from neural_shadows.training.batches import batch_indices

if TYPE_CHECKING:
    from neural_shadows.training.screen_batches import ScreenFrames

_DRAWS = 7  # numbers that are drawn for a crop


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


def crop_places(
    frames: "ScreenFrames",
    step: int,
    *,
    seed: int,
    crops: int,
    crop: int,
    flips: bool,
    twins: bool,
    pairs: bool = False,
    lights: Sequence[int] | None = None,
) -> list[Place]:
    """The crops of a step; they depend on (seed, step) alone.

    Args:
        crop: side in pixels; where the frame is smaller, all of it is taken.
        twins: whether each has one of the frame's twins.
        pairs: whether each second one has another radius than the one before it.
        lights: numbers of the radii that are drawn from; None for all.
    """
    drawn = batch_indices(torch.tensor(step), seed=seed, batch_size=_DRAWS * crops, count=1 << 62)
    drawn = drawn.view(crops, _DRAWS)
    spare = [max(side - crop, 0) + 1 for side in (frames.height, frames.width)]
    versions = frames.twins if twins else 1
    sides = 2 if flips else 1
    radii = range(frames.radii) if lights is None else lights
    chosen = drawn % torch.tensor([len(frames), len(radii), versions, *spare, sides, sides])
    if pairs and len(radii) > 1:
        before, other = chosen[: crops - 1 : 2, 1], drawn[1::2, 1] % (len(radii) - 1)
        chosen[1::2, 1] = (before + 1 + other) % len(radii)
    return [
        Place(frame, radii[radius], twin + 1 if twins else 0, top, left, bool(down), bool(mirrored))
        for frame, radius, twin, top, left, down, mirrored in chosen.tolist()
    ]
