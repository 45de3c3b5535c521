"""Convolutions of a network by its widths, and their counts.

Tables S2, S4 and S5 of Datta et al. 2022 determine every layer. A level of the trimmed network is a
3 × 3 convolution (in → mid) and a 1 × 1 (mid → out) on the way down, and the same on the way up,
where the 1 × 1 goes to the channels of the level above; the deepest level has the first pair alone.
The paper counts a multiply-add as one operation, weights without biases, and as storage the
channels read and written by each convolution.
"""

from collections.abc import Sequence
from dataclasses import dataclass

Widths = Sequence[int | Sequence[int]]  # a level's width, or its [mid, out]

EXTRACTED = 4  # outputs of a learned extraction (3.2)


@dataclass(frozen=True)
class Convolution:
    """A convolution at level k, on (H / 2^k) × (W / 2^k) pixels."""

    level: int
    part: str  # `extraction`, `encoder`, `upsample`, `decoder` or `head`
    size: int  # of its kernel
    inputs: int
    outputs: int
    transposed: bool = False  # reads level k + 1 and writes level k, without overlap

    @property
    def weights(self) -> int:
        """Weights without biases."""
        return self.size**2 * self.inputs * self.outputs

    @property
    def macs(self) -> float:
        """Multiply-adds for a pixel of the whole frame."""
        return self.weights / 4 ** (self.level + self.transposed)

    @property
    def storage(self) -> float:
        """Numbers read and written, for a pixel of the frame."""
        read = self.inputs / 4 if self.transposed else self.inputs
        return (read + self.outputs) / 4**self.level


def first_level(form: str) -> int:
    """First level of the convolutions: 1 without the frame's own size."""
    return int(form not in ("full", "original"))


def deepest_level(form: str, widths: Widths) -> int:
    """Last level: frames' sides are multiples of 2 to its power."""
    return first_level(form) + len(widths) - 1


def outputs_of(form: str) -> int:
    """Output channels of the convolutions; four make a 2 × 2 square."""
    return 4 if form == "shuffle" else 1


def convolutions(
    form: str, widths: Widths, channels: int, extraction: int | None = None
) -> list[Convolution]:
    """All convolutions of a network, in order of computation.

    Args:
        form: `full`, `shuffle`, `half` or `original`. widths: of each level, from the first.
        channels: of its input.
        extraction: hidden channels of a learned reduction to `EXTRACTED`; None for none.
    """
    reduction = []
    if extraction is not None:
        reduction += [
            Convolution(0, "extraction", 1, channels, extraction),
            Convolution(0, "extraction", 1, extraction, EXTRACTED),
        ]
        channels = EXTRACTED
    channels *= 4 if form == "shuffle" else 1
    layers = _original if form == "original" else _trimmed
    return reduction + layers(form, widths, channels)


def _trimmed(form: str, widths: Widths, channels: int) -> list[Convolution]:
    pairs = [(width, width) if isinstance(width, int) else tuple(width) for width in widths]
    first, deepest = first_level(form), deepest_level(form, widths)
    down, up, above = [], [], channels
    for level, (mid, out) in enumerate(pairs, first):
        out = above if level == deepest else out
        down += [Convolution(level, "encoder", 3, above, mid)]
        down += [Convolution(level, "encoder", 1, mid, out)]
        if level < deepest:
            # The full form has one more 1 × 1 after its first level; the others end with that one.
            last = (mid, 1) if form == "full" else (outputs_of(form),)
            ends = last if level == first else (above,)
            sizes = (out, mid, *ends)
            up = [
                Convolution(level, "decoder", 3 if number == 0 else 1, *pair)
                for number, pair in enumerate(zip(sizes, sizes[1:]))
            ] + up
        above = out
    return down + up


def _original(form: str, widths: Widths, channels: int) -> list[Convolution]:
    """Convolutions before trimming: two 3 × 3 a level, transposed ones, concatenation."""
    down, up, above = [], [], channels
    for level, width in enumerate(widths):
        down += [Convolution(level, "encoder", 3, above, width)]
        down += [Convolution(level, "encoder", 3, width, width)]
        if level:
            finer = level - 1
            up = [
                Convolution(finer, "upsample", 2, width, above, transposed=True),
                Convolution(finer, "decoder", 3, 2 * above, above),
                Convolution(finer, "decoder", 3, above, above),
            ] + up
        above = width
    return down + up + [Convolution(0, "decoder", 1, widths[0], outputs_of(form))]


def by_level(layers: Sequence[Convolution], quantity: str) -> dict[int, float]:
    """Sums of `weights`, `macs` or `storage` over each level's convolutions."""
    sums = dict.fromkeys(sorted({layer.level for layer in layers}), 0.0)
    for layer in layers:
        sums[layer.level] += getattr(layer, quantity)
    return sums


def total(layers: Sequence[Convolution], quantity: str) -> float:
    """Sum over all levels."""
    return sum(by_level(layers, quantity).values())
