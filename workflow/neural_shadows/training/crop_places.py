"""Which crops a step draws."""

from collections.abc import Sequence

import torch

from neural_shadows.training.batches import batch_indices
from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_crops import Place

_DRAWS = 7  # numbers that are drawn for a crop


def crop_places(
    frames: ScreenFrames,
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
