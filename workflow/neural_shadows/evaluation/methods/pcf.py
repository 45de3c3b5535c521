"""Percentage-closer filtering by a kernel of one width (Reeves et al. 1987).

A kernel fits one penumbra width. That of k × k texels is independent of the light; the disc's radius
is tuned for each.
"""

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import SKY, Look
from neural_shadows.evaluation.method import Method

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame

LOOK = Look(
    "percentage-closer filtering",
    SKY,
    "D",
    "◆",
    "Averages the tests around a pixel's texel, equally blurred everywhere.",
)

# Times the bias of a test against one texel.
BIASES = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
_SAMPLES = 128  # as in Hu et al. 2025, 6.1


def _box(frame: "SoftFrame", radius: float, *, size: int, bias: float) -> np.ndarray:
    """The mean of size × size bilinearly weighted tests; size is odd."""
    from neural_shadows.shadow_maps.box_filter import box_visibility

    biases = np.float32(bias) * frame.bias
    receivers = frame.from_light, frame.surface.n_g, biases
    return box_visibility(frame.light_map, frame.depths, *receivers, size=size)


def _disc(frame: "SoftFrame", radius: float, *, texels: float, bias: float) -> np.ndarray:
    from neural_shadows.shadow_maps.light_filters import disc_visibility

    return disc_visibility(
        frame.light_map,
        frame.depths,
        frame.from_light,
        frame.surface.n_g,
        np.float32(bias) * frame.bias,
        texels=texels,
        samples=_SAMPLES,
        keys=frame.surface.pixel,
    )


# The width is chosen at the bias in the middle: one texel's.
_DISC = {"texels": (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0), "bias": BIASES[:-1]}
METHODS = {
    **{
        f"pcf_{size}": Method(
            partial(_box, size=size), {"bias": BIASES}, f"PCF {size} × {size}", of_radius=False
        )
        for size in (3, 5, 9, 15)
    },
    "pcf_disc": Method(_disc, _DISC, "PCF, disc", of_radius=False),  # but by its constants
}
