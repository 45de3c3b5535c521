"""The filter of Kernel Predicting Neural Shadow Maps: each pixel has kernels of its own."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from neural_shadows.networks.screen_space.pixel_kernel_loops import (
    SIDE,
    TAPS,
    add_gradients,
    filter_rows,
)

_BITS = {torch.float32: torch.int32, torch.bfloat16: torch.int16}


def filtered(logits: Tensor, base: Tensor, factor: int = 1) -> Tensor:
    """A picture, filtered by each pixel's kernels (Hu et al. 2025, 3): (B, 1, H, W) float32.

    Kernels of 5 × 5 taps, level l with 2^l pixels between them, one after the other from level 0 on.
    Their weights are the softmax of their logits over the taps within the frame, which is the
    softmax over all, renormalised at borders; so kernels may be larger than the frame. A result
    is within the base's smallest and largest values that its kernels reach: 61 × 61 pixels of four.

    Args:
        logits: (B, levels · 25, h, w), a level's taps row by row; copied unless contiguous.
        base: (B, 1, H, W) float32. H ≤ factor · h and W ≤ factor · w: the rest is not looked at.
        factor: 1, or 2 where logits are of half the resolution: they are enlarged bilinearly.

    Raises:
        ValueError: the logits do not cover the base, or are not of whole levels.
    """
    covers = all(side <= factor * low for side, low in zip(base.shape[-2:], logits.shape[-2:]))
    if not covers or len(base) != len(logits) or logits.shape[1] % TAPS:
        raise ValueError(
            f"kernels of {tuple(logits.shape)}, enlarged {factor} times, do not fit a base of "
            f"{tuple(base.shape)}"
        )
    if base.device.type != "cpu":
        return by_shifts(logits, base, factor)
    if logits.dtype not in _BITS:
        logits = logits.float()
    return _Filter.apply(logits, base.float(), factor)


class _Filter(torch.autograd.Function):
    """On a CPU. Weights are made anew on the way back: kept are logits and a picture a level."""

    @staticmethod
    def forward(ctx, logits: Tensor, base: Tensor, factor: int) -> Tensor:
        """See `filtered`."""
        logits = logits.detach().contiguous()
        pictures = [np.ascontiguousarray(base.detach()[:, 0].numpy())]
        for level, bits in enumerate(_levels(logits)):
            result = np.empty_like(pictures[-1])
            _in_bands(bits, factor, 2**level, pictures[-1], result)
            pictures.append(result)
        ctx.save_for_backward(logits)
        ctx.pictures, ctx.factor = pictures, factor
        return torch.from_numpy(pictures[-1])[:, None]

    @staticmethod
    def backward(ctx, gradient: Tensor) -> tuple[Tensor, Tensor, None]:
        """Of the logits, in their format, and of the base."""
        (logits,) = ctx.saved_tensors
        # By numpy, whose zeros are not written before they are added to.
        to_logits = torch.from_numpy(np.zeros(logits.shape, np.float32))
        given = np.ascontiguousarray(gradient[:, 0].numpy())
        levels = list(enumerate(zip(_levels(logits), to_logits.split(TAPS, dim=1))))
        for level, (bits, of_level) in reversed(levels):
            to_source = np.zeros_like(given)
            source, result = ctx.pictures[level : level + 2]
            for image, here in enumerate(of_level.numpy()):
                ours = (array[image] for array in (source, result, given, to_source))
                add_gradients(bits[image], ctx.factor, 2**level, *ours, here)
            given = to_source
        return to_logits.to(logits.dtype), torch.from_numpy(given)[:, None], None


def _levels(logits: Tensor) -> Iterator[np.ndarray]:
    """(B, 25, h, w) of each level, as integers: numpy has no bfloat16."""
    for level in logits.view(_BITS[logits.dtype]).split(TAPS, dim=1):
        yield level.numpy()


def _in_bands(
    bits: np.ndarray, factor: int, step: int, source: np.ndarray, result: np.ndarray
) -> None:
    """A level of some pictures; rows are shared among torch's threads."""
    height, threads = source.shape[1], torch.get_num_threads()
    ends = [height * number // threads for number in range(threads + 1)]
    bands = [
        (bits[image], factor, step, source[image], *rows, result[image])
        for image in range(len(source))
        for rows in zip(ends, ends[1:])
    ]
    if threads == 1:
        for band in bands:
            filter_rows(*band)
        return
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(lambda band: filter_rows(*band), bands))


def by_shifts(logits: Tensor, base: Tensor, factor: int = 1) -> Tensor:
    """The same by operations of torch's own, for a GPU: no picture is copied tap by tap."""
    if factor > 1:
        logits = functional.interpolate(logits, scale_factor=factor, mode="bilinear")
    height, width = base.shape[-2:]
    picture = base
    for level, own in enumerate(logits[..., :height, :width].split(TAPS, dim=1)):
        step, border = 2**level, SIDE // 2 * 2**level
        places = [(row * step, column * step) for row in range(SIDE) for column in range(SIDE)]

        def shifted(padded: Tensor, places=places) -> list[Tensor]:
            return [padded[..., y : y + height, x : x + width] for y, x in places]

        inside = shifted(functional.pad(torch.ones_like(base[:1]), [border] * 4))
        weights = own.to(base.dtype).masked_fill(torch.cat(inside, dim=1) == 0, -torch.inf)
        seen = shifted(functional.pad(picture, [border] * 4))
        parts = zip(weights.softmax(dim=1).split(1, dim=1), seen)
        picture = sum(weight * values for weight, values in parts)
    return picture
