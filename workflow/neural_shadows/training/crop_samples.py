"""Random crops of a step."""

from collections.abc import Sequence

import torch

from neural_shadows.training.batches import batch_indices
from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_crops import CropSample

_DRAWS = 7  # random numbers of a crop


def crop_samples(
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
) -> list[CropSample]:
    """Crops of a step, determined by (seed, step).

    Args:
        crop: side in pixels; the whole frame if that is smaller.
        twins: with one of the frame's perturbed frames each.
        pairs: each second crop has another radius than the one before.
        lights: indices of the radii to draw from; None for all.
    """
    numbers = batch_indices(torch.tensor(step), seed=seed, batch_size=_DRAWS * crops, count=1 << 62)
    numbers = numbers.view(crops, _DRAWS)
    spare = [max(side - crop, 0) + 1 for side in (frames.height, frames.width)]
    versions = frames.twins if twins else 1
    sides = 2 if flips else 1
    radii = range(frames.radii) if lights is None else lights
    choices = numbers % torch.tensor([len(frames), len(radii), versions, *spare, sides, sides])
    if pairs and len(radii) > 1:
        before, other = choices[: crops - 1 : 2, 1], numbers[1::2, 1] % (len(radii) - 1)
        choices[1::2, 1] = (before + 1 + other) % len(radii)
    return [
        CropSample(
            frame, radii[radius], twin + 1 if twins else 0, top, left, bool(down), bool(mirrored)
        )
        for frame, radius, twin, top, left, down, mirrored in choices.tolist()
    ]
