"""Convolutions of networks of kernels (Hu et al. 2025, 4.2.1, and its code).

The first level is 1, with 2 × 2 pixels as channels; with full ends, which the paper replaced, 0.
Counts as in `widths.py`.
"""

from collections.abc import Sequence
from typing import Any

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space.widths import Convolution
from neural_shadows.networks.settings.screen_space import UnetOfSums

FIRST_LEVELS = {"half": 1, "full": 0}  # by the resolution of a network's ends
KERNEL_TAPS = 25  # of a kernel
_BEFORE_LAST = 16  # channels before the direct form's output


def convolutions(settings: UnetOfSums) -> list[Convolution]:
    """All convolutions of a form, in order of computation."""
    chosen = settings.model_dump(include={"form", "widths", "filters", "ends"})
    return kernel_convolutions(**chosen, channels=channels_of(settings.features))


def network(settings: UnetOfSums) -> Any:
    """A network of kernels or of visibility."""
    from neural_shadows.networks.screen_space.kernel_unet import KernelUnet

    return KernelUnet(**settings.model_dump())


def kernel_convolutions(
    form: str, widths: Sequence[int], channels: int, filters: int = 0, ends: str = "half"
) -> list[Convolution]:
    """All convolutions of a network, in order of computation.

    Args:
        form: `kernels`, or `direct`, which outputs visibility.
        widths: channels of each level, from the first. channels: of its input.
        filters: kernels of a pixel; unused by the direct form.
        ends: one of `FIRST_LEVELS`; of the direct form `half`.

    Raises:
        KeyError: unknown ends.
    """
    first = FIRST_LEVELS[ends]
    down, up = [Convolution(1, "encoder", 1, 4 * channels, widths[0])], []
    if ends == "full":  # a level like the others
        down = _pair(0, "encoder", channels, widths[0])
    for level, (above, width) in enumerate(zip(widths, widths[1:]), first + 1):
        down += _pair(level, "encoder", above, width)
        upsampling = Convolution(level - 1, "upsample", 2, width, above, transposed=True)
        up = [upsampling, *_pair(level - 1, "decoder", above, above)] + up
    if form == "kernels":
        return down + up + [Convolution(first, "head", 1, widths[0], filters * KERNEL_TAPS)]
    return (
        down
        + up
        + [
            Convolution(0, "head", 3, widths[0], _BEFORE_LAST),
            Convolution(0, "head", 1, _BEFORE_LAST, 1),
        ]
    )


def _pair(level: int, part: str, inputs: int, outputs: int) -> list[Convolution]:
    return [Convolution(level, part, 3, into, outputs) for into in (inputs, outputs)]
