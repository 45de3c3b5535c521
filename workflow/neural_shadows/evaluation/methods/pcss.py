"""Percentage-closer soft shadows: blurred by blockers' distance (Fernando 2005).

With 64 samples of the search and 128 of the filter (Hu et al. 2025, 6.1). The constant `nearest` is
where blockers may begin, of the way from the map's near plane to a receiver, and so how widely they are
searched: too widely, those of other penumbrae are averaged in (squared error under the largest light of
`windows`, of the way from the light: 44 × 10⁻⁴ at 0.25, 27 as chosen). `scale` scales the light; a point
light has the four tests round each receiver. Half the taps err 1 to 3 % more, in three quarters of the time
(validation frames of `windows`). To end where the search finds blockers alone saves a fifth of it, and errs up to
8 % more.
"""

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import BLUE, Look
from neural_shadows.evaluation.method import Method

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame
    from neural_shadows.rendering.surface import Surface

LOOK = Look(
    "percentage-closer soft shadows",
    BLUE,
    "P",
    "✚",
    "Searches for blockers first, and sets the filter's width by them.",
)


def _visibility(
    frame: "SoftFrame",
    radius: float,
    *,
    taps: tuple[int, int],
    nearest: float,
    scale: float,
    bias: float,
) -> np.ndarray:
    from neural_shadows.shadow_maps.box_filter import box_visibility
    from neural_shadows.shadow_maps.light_filters import soft_disc_visibility

    receivers = frame.from_light, frame.surface.n_g, np.float32(bias) * frame.bias
    if radius == 0:
        return box_visibility(frame.light_map, frame.depths, *receivers, size=1)
    return soft_disc_visibility(
        frame.light_map,
        frame.depths,
        *receivers,
        radius=scale * radius,
        searched=taps[0],
        samples=taps[1],
        nearest=nearest,
        keys=frame.surface.pixel,
    )


def _filtered(surface: "Surface", shares: np.ndarray, *, width: float) -> np.ndarray:
    from neural_shadows.evaluation.method_parts.depth_aware_filter import depth_aware

    return depth_aware(surface, shares, width) if width else shares


# One after another, in two rounds. By one round the error under the largest light of `frames` was 8 % above that of
# all 96 settings of two biases, by two none was, there and in `windows`
# (half the validation frames). Under the sun's and the panel's lights one round gave the least of 288.
CONSTANTS = {
    "bias": (0.03, 0.1, 0.3, 1.0, 3.0),
    "scale": (0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0),
    "nearest": (0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95),
}
# The filter's standard deviation in pixels; 0 is no filter. With 1.5 throughout, windows of a tree had
# 3.8 times the error that PCSS has alone.
_WIDTHS = {"width": (0.0, 0.35, 0.5, 0.7, 1.0, 1.5, 2.2)}
_PCSS = Method(partial(_visibility, taps=(64, 128)), CONSTANTS, "PCSS", rounds=2)
_FEW = Method(partial(_visibility, taps=(32, 64)), CONSTANTS, "PCSS, half the taps", rounds=2)
_FINE = replace(_PCSS, label="PCSS, map of 2048²", resolution=2048)


def _with_filter(method: Method) -> Method:
    label = f"{method.label}, depth-aware filter"
    constants = method.constants | _WIDTHS
    return replace(method, label=label, constants=constants, last=_filtered, of_last=(*_WIDTHS,))


METHODS = {
    "pcss": _PCSS,
    "pcss_post": _with_filter(_PCSS),
    "pcss_few": _FEW,
    "pcss_2048": _FINE,
    "pcss_2048_post": _with_filter(_FINE),
}
