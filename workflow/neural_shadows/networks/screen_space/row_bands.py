"""Networks in bands of rows, for inference on a CPU.

Layers of a level follow each other on a band while it is in the caches, and activations are part of
convolutions. Layer by layer, a frame of 2048 × 1024 writes and reads 67 MB each, in fresh memory:
in float32 with AVX2 a tenth of the processor time on one thread, a fifth on two.
"""

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from threading import Lock
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from neural_shadows.networks.compute import is_native
from neural_shadows.networks.screen_space.kernel_taps import TAPS
from neural_shadows.networks.screen_space.layers import (
    Halved,
    ReplicatedConvolution,
    SquareOfPixels,
    SquaresAsChannels,
)
from neural_shadows.networks.screen_space.pixel_kernel_loops import filter_rows
from neural_shadows.networks.screen_space.pixel_kernels import bits_of

ROWS = 32  # of a band, even. 16 take 6 % longer, 64 leave a thread idle at the deepest level
_CPU = torch.device("cpu")
_HALVING = (nn.AvgPool2d, nn.MaxPool2d, Halved)
_DOUBLING = (nn.ConvTranspose2d, nn.Upsample, SquareOfPixels)


class Picture(NamedTuple):
    """A picture by rows, computed when read."""

    height: int
    rows: Callable[[int, int], Tensor]  # [begin, end), as (B, C, end − begin, W)
    pixels: "Picture | None" = None  # of which it has squares of 2 × 2 as channels


def stored(x: Tensor) -> Picture:
    """A tensor (B, C, H, W) as a picture."""
    return Picture(x.shape[2], lambda begin, end: x[:, :, begin:end])


def mapped(function: Callable[[Tensor], Tensor], picture: Picture, factor: int = 1) -> Picture:
    """Apply a function of squares of pixels, `factor` high."""
    return Picture(
        picture.height // factor,
        lambda begin, end: function(picture.rows(factor * begin, factor * end)),
    )


def through(module: nn.Module, picture: Picture) -> Picture:
    """A module's output.

    Raises:
        TypeError: a module without a form by rows.
    """
    if isinstance(module, nn.Sequential):
        for layer, following in zip(module, [*module[1:], None]):
            if isinstance(layer, nn.Conv2d):
                picture = _convolved(layer, picture, isinstance(following, nn.ReLU))
            elif not isinstance(layer, nn.ReLU):
                picture = through(layer, picture)
        return picture
    if isinstance(module, nn.Conv2d):
        return _convolved(module, picture, False)
    if isinstance(module, SquaresAsChannels):
        return mapped(module, picture, 2)._replace(pixels=picture)
    if isinstance(module, _HALVING):
        return mapped(lambda rows: _halved(module, rows), picture, 2)
    if isinstance(module, SquareOfPixels):  # in planes a third of the time
        picture = mapped(Tensor.contiguous, picture)
    if isinstance(module, _DOUBLING):
        return _doubled(module, picture)
    if module is None or isinstance(module, nn.Identity):
        return picture
    raise TypeError(f"{type(module).__name__} has no form by rows")


def _convolved(layer: nn.Conv2d, picture: Picture, relu: bool) -> Picture:
    if layer.kernel_size == (1, 1) and picture.pixels is not None:
        return _convolved_squares(layer, picture.pixels, relu)
    border, height = layer.kernel_size[0] // 2, picture.height
    convolve = _convolution(layer.weight, layer.bias, 1, relu)

    def rows(begin: int, end: int) -> Tensor:
        low, high = max(begin - border, 0), min(end + border, height)
        x = picture.rows(low, high)
        above, below = low - begin + border, end + border - high  # beyond the frame
        columns = border
        if border and isinstance(layer, ReplicatedConvolution):
            x = functional.pad(x, (border, border, above, below), mode="replicate")
            columns = 0
        elif above or below:
            x = functional.pad(x, (0, 0, above, below))
        return convolve(x, (0, columns))

    return Picture(height, rows)


def _convolved_squares(layer: nn.Conv2d, pixels: Picture, relu: bool) -> Picture:
    """A convolution of 2 × 2 pixels as channels, without gathering these: a third of the time."""
    weight = layer.weight.view(len(layer.weight), -1, 2, 2)
    weight = weight.contiguous(memory_format=torch.channels_last)
    convolve = _convolution(weight, layer.bias, 2, relu)
    return mapped(lambda rows: convolve(rows, (0, 0)), pixels, 2)


def _convolution(
    weight: Tensor, bias: Tensor | None, stride: int, relu: bool
) -> Callable[[Tensor, tuple[int, int]], Tensor]:
    """A convolution of rows, padded by (rows, columns); its activation in the same pass, if oneDNN can."""
    if torch.backends.mkldnn.is_available() and is_native(weight.dtype, _CPU):
        steps, activation = (stride, stride), "relu" if relu else "none"
        convolve = torch.ops.mkldnn._convolution_pointwise
        return lambda x, padding: convolve(
            x, weight, bias, padding, steps, (1, 1), 1, activation, [], ""
        )

    def in_two_passes(x: Tensor, padding: tuple[int, int]) -> Tensor:
        y = functional.conv2d(x, weight, bias, stride, padding)
        return y.relu_() if relu else y

    return in_two_passes


def _halved(module: nn.Module, x: Tensor) -> Tensor:
    """`module(x)` of even sides; torch's maximum of 2 × 2 pixels also finds its place, in twice the time."""
    if not isinstance(module, nn.MaxPool2d):
        return module(x)
    rows = torch.maximum(x[:, :, ::2], x[:, :, 1::2])
    return torch.maximum(rows[..., ::2], rows[..., 1::2])


def _doubled(module: nn.Module, picture: Picture) -> Picture:
    def rows(begin: int, end: int) -> Tensor:
        low, high = max(begin // 2 - 1, 0), min((end + 1) // 2 + 1, picture.height)
        return module(picture.rows(low, high))[:, :, begin - 2 * low : end - 2 * low]

    return Picture(2 * picture.height, rows)


def unet(levels: Iterable[nn.Module], deepest: nn.Module, picture: Picture) -> Picture:
    """`down_and_up` of a picture."""
    skips = []
    for level in levels:
        encoded = through(level.encoder, picture)

        def both(begin: int, end: int, encoded=encoded, level=level) -> tuple[Tensor, Tensor]:
            band = encoded.rows(begin, end)
            return band, _halved(level.downsample, band)

        skip, smaller = _in_bands(encoded.height, both)
        skips.append(skip)
        picture = stored(smaller)
    picture = stored(computed(through(deepest, picture)))
    for number, level in reversed([*enumerate(levels)]):
        picture = _joined(level.skip, through(level.upsample, picture), skips.pop())
        picture = through(level.decoder, picture)
        if number:
            picture = stored(computed(picture))
    return picture


def _joined(skip: nn.Module | None, below: Picture, encoded: Tensor) -> Picture:
    if skip is None:
        return below
    return Picture(
        below.height, lambda begin, end: skip(below.rows(begin, end), encoded[:, :, begin:end])
    )


def computed(picture: Picture) -> Tensor:
    """All rows, (B, C, H, W), by torch's threads."""
    (x,) = _in_bands(picture.height, lambda begin, end: (picture.rows(begin, end),))
    return x


def _in_bands(height: int, band: Callable[[int, int], tuple[Tensor, ...]]) -> list[Tensor]:
    """Pictures from their bands; of smaller ones the rows in proportion."""
    pictures: list[Tensor] = []
    lock = Lock()

    def fill(begin: int, end: int) -> None:
        bands = band(begin, end)
        with lock:
            if not pictures:  # their size is that of the first to come
                pictures.extend(_empty(rows, height / (end - begin)) for rows in bands)
        for rows, picture in zip(bands, pictures):
            first = begin * rows.shape[2] // (end - begin)
            picture[:, :, first : first + rows.shape[2]] = rows

    _for_bands(fill, height)
    return pictures


def _empty(rows: Tensor, bands: float) -> Tensor:
    batch, channels, height, width = rows.shape
    size = batch, channels, round(height * bands), width
    return torch.empty(size, dtype=rows.dtype, memory_format=torch.channels_last)


def _for_bands(fill: Callable[[int, int], None], height: int) -> None:
    """Call for the rows of each band, by torch's threads."""
    spans = [(row, min(row + ROWS, height)) for row in range(0, height, ROWS)]
    threads = min(torch.get_num_threads(), len(spans))

    def fill_span(span: tuple[int, int]) -> None:
        with torch.inference_mode():  # a thread's own
            fill(*span)

    if threads <= 1:
        for span in spans:
            fill_span(span)
        return
    # A band in each thread: threads inside each layer would wait for each other.
    with ThreadPoolExecutor(threads, initializer=torch.set_num_threads, initargs=(1,)) as pool:
        list(pool.map(fill_span, spans))


def filtered(
    head: nn.Conv2d, inner: Tensor, base: Tensor, factor: int, guide: Tensor, limit: float
) -> Tensor:
    """`pixel_kernels.filtered` by the output of a head, never stored whole.

    Args:
        head: of 1 × 1 pixels. inner: its input (B, C, h, w). base, factor, guide, limit: as there.
    """
    weights, biases = head.weight.flatten(1).split(TAPS), head.bias[:, None].split(TAPS)
    results = []
    for image, *planes in zip(inner, base[:, 0].float().numpy(), guide[:, 0].float().numpy()):
        picture, of_picture = map(np.ascontiguousarray, planes)
        gate = of_picture, np.float32(limit)
        for level, of_level in enumerate(zip(weights, biases)):
            picture = _filtered_level(*of_level, image, picture, gate, 2**level, factor)
        results.append(torch.from_numpy(picture))
    return torch.stack(results)[:, None]


def _filtered_level(
    weight: Tensor,
    bias: Tensor,
    inner: Tensor,
    source: np.ndarray,
    gate: tuple[np.ndarray, np.float32],
    step: int,
    factor: int,
) -> np.ndarray:
    result = np.empty_like(source)

    def fill(begin: int, end: int) -> None:
        low, high = max(begin // factor - 1, 0), -(-end // factor) + 1
        rows = inner[:, low:high]
        logits = torch.addmm(bias, weight, rows.flatten(1)).view(TAPS, *rows.shape[1:])
        rows = begin, end, result, factor * low
        filter_rows(bits_of(logits), factor, step, source, *gate, *rows)

    _for_bands(fill, len(source))
    return result
