"""Per-pixel kernel filter of Kernel Predicting Neural Shadow Maps."""

import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from neural_shadows.networks.screen_space.kernel_taps import SIDE, TAPS
from neural_shadows.networks.screen_space.pixel_kernel_loops import add_gradients, filter_rows

_BITS = {torch.float32: torch.int32, torch.bfloat16: torch.int16}


def filtered(
    logits: Tensor,
    base: Tensor,
    factor: int = 1,
    guide: Tensor | None = None,
    limit: float = math.inf,
) -> Tensor:
    """Filter a picture by each pixel's kernels (Hu et al. 2025, 3).

    (B, 1, H, W) float32. Kernels of 5 × 5 taps, 2^l pixels apart at level l, applied from level 0
    on. Their weights are the softmax of their logits over the taps within the frame, which is the
    softmax over all, renormalised at borders; so kernels may be larger than the frame. A result is
    within the base's minimum and maximum over its kernels: 61 × 61 pixels for four.

    Args:
        logits: (B, levels · 25, h, w), a level's taps row by row; copied unless contiguous.
        base: (B, 1, H, W) float32. H ≤ factor · h and W ≤ factor · w: the rest is ignored.
        factor: 1, or 2 where logits are of half the resolution: they are enlarged bilinearly.
        guide: as the base, finite, without gradients. limit: taps that differ more from their kernel's pixel
            in the guide have no weight, so that no shadow goes across a silhouette.

    Raises:
        ValueError: logits that do not cover the base, or not of whole levels.
    """
    covers = all(side <= factor * low for side, low in zip(base.shape[-2:], logits.shape[-2:]))
    if not covers or len(base) != len(logits) or logits.shape[1] % TAPS:
        raise ValueError(
            f"kernels of {tuple(logits.shape)}, enlarged {factor} times, do not fit a base of "
            f"{tuple(base.shape)}"
        )
    if base.device.type != "cpu":
        return by_shifts(logits, base, factor, guide, limit)
    if logits.dtype not in _BITS:
        logits = logits.float()
    guide = base if guide is None else guide
    return _Filter.apply(logits, base.float(), factor, guide.float(), limit)


class _Filter(torch.autograd.Function):
    """The filter on a CPU; the backward pass recomputes weights."""

    @staticmethod
    def forward(ctx, logits: Tensor, base: Tensor, factor: int, guide: Tensor, limit: float):
        """See `filtered`."""
        logits = logits.detach().contiguous()
        base, guide = (np.ascontiguousarray(x.detach()[:, 0].numpy()) for x in (base, guide))
        pictures, gate = [base], (guide, np.float32(limit))
        for level, bits in enumerate(_levels(logits)):
            result = np.empty_like(base)
            _in_bands(bits, factor, 2**level, pictures[-1], gate, result)
            pictures.append(result)
        ctx.save_for_backward(logits)
        ctx.pictures, ctx.factor, ctx.gate = pictures, factor, gate
        return torch.from_numpy(pictures[-1])[:, None]

    @staticmethod
    def backward(ctx, gradient: Tensor) -> tuple[Tensor, Tensor, None, None, None]:
        """Gradients: of the logits, in their format, and of the base."""
        (logits,) = ctx.saved_tensors
        # numpy's zeros are not written before additions.
        to_logits = torch.from_numpy(np.zeros(logits.shape, np.float32))
        to_result = np.ascontiguousarray(gradient[:, 0].numpy())
        levels = list(enumerate(zip(_levels(logits), to_logits.split(TAPS, dim=1))))
        for level, (bits, to_level) in reversed(levels):
            to_source = np.zeros_like(to_result)
            source, result = ctx.pictures[level : level + 2]
            guide, limit = ctx.gate
            for image, to_kernels in enumerate(to_level.numpy()):
                arrays = (array[image] for array in (result, to_result, to_source))
                gate = guide[image], limit
                level_of = bits[image], ctx.factor, 2**level, source[image]
                add_gradients(*level_of, *gate, *arrays, to_kernels)
            to_result = to_source
        to_base = torch.from_numpy(to_result)[:, None]
        return to_logits.to(logits.dtype), to_base, None, None, None


def _levels(logits: Tensor) -> Iterator[np.ndarray]:
    """Each level's logits (B, 25, h, w), as integers for numpy without bfloat16."""
    yield from (bits_of(level) for level in logits.split(TAPS, dim=1))


def bits_of(logits: Tensor) -> np.ndarray:
    """Logits as integers of their bits; of other formats than float32 and bfloat16 as float32."""
    if logits.dtype not in _BITS:
        logits = logits.float()
    return logits.view(_BITS[logits.dtype]).numpy()


def _in_bands(
    bits: np.ndarray,
    factor: int,
    step: int,
    source: np.ndarray,
    gate: tuple[np.ndarray, np.float32],
    result: np.ndarray,
) -> None:
    """Filter a level of pictures in bands, by torch's threads."""
    height, threads = source.shape[1], torch.get_num_threads()
    guide, limit = gate
    ends = [height * number // threads for number in range(threads + 1)]
    bands = [
        (bits[image], factor, step, source[image], guide[image], limit, *rows, result[image], 0)
        for image in range(len(source))
        for rows in zip(ends, ends[1:])
    ]
    if threads == 1:
        for band in bands:
            filter_rows(*band)
        return
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(lambda band: filter_rows(*band), bands))


def by_shifts(
    logits: Tensor,
    base: Tensor,
    factor: int = 1,
    guide: Tensor | None = None,
    limit: float = math.inf,
) -> Tensor:
    """`filtered` by torch operations, for a GPU: no copies by tap."""
    height, width = base.shape[-2:]
    picture = base
    for level, level_logits in enumerate(logits.split(TAPS, dim=1)):
        # Before they are enlarged: of 16 in bfloat16 each rounding is up to 6 % of a weight.
        level_logits = level_logits.to(base.dtype)
        if factor > 1:
            level_logits = functional.interpolate(
                level_logits, scale_factor=factor, mode="bilinear"
            )
        step, border = 2**level, SIDE // 2 * 2**level
        offsets = [(row * step, column * step) for row in range(SIDE) for column in range(SIDE)]

        def shifted(padded: Tensor, offsets=offsets) -> list[Tensor]:
            return [padded[..., y : y + height, x : x + width] for y, x in offsets]

        inside = torch.cat(shifted(functional.pad(torch.ones_like(base), [border] * 4)), dim=1) == 1
        if limit < math.inf:
            others = torch.cat(shifted(functional.pad(guide, [border] * 4)), dim=1)
            inside = inside & ((others - guide).abs() <= limit)
        weights = level_logits[..., :height, :width].masked_fill(~inside, -torch.inf)
        values = shifted(functional.pad(picture, [border] * 4))
        parts = zip(weights.softmax(dim=1).split(1, dim=1), values)
        picture = sum(weight * value for weight, value in parts)
    return picture
