"""Percentage-closer soft shadows: as blurred as the blockers that are found say (Fernando 2005).

With 64 samples of the search and 128 of the filter (Hu et al. 2025, 6.1). The constant `scale`
makes the light larger or smaller than it is; a point light has the four tests round each receiver.
"""

from dataclasses import replace

import numpy as np

from neural_shadows.evaluation.soft_methods.depth_aware_filter import depth_aware
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.shadow_maps.box_filter import box_visibility
from neural_shadows.shadow_maps.light_filters import soft_disc_visibility


def _answer(frame: SoftFrame, radius: float, *, scale: float, bias: float) -> np.ndarray:
    receivers = frame.ways, frame.surface.n_g, np.float32(bias) * frame.bias
    if radius == 0:
        return box_visibility(frame.light_map, frame.depths, *receivers, size=1)
    return soft_disc_visibility(
        frame.light_map,
        frame.depths,
        *receivers,
        radius=scale * radius,
        keys=frame.surface.pixel,
    )


_PCSS = SoftMethod(_answer, {"scale": (0.5, 0.7, 1.0, 1.4, 2.0), "bias": (0.1, 0.3, 1.0, 3.0)})
METHODS = {
    "pcss": _PCSS,
    "pcss_post": replace(_PCSS, last=depth_aware),
    "pcss_2048": replace(_PCSS, resolution=2048),
    "pcss_2048_post": replace(_PCSS, resolution=2048, last=depth_aware),
}
