"""What networks begin with: as a frame's buffers hold it, a user's own frames' too, or by a map."""

from functools import partial

import numpy as np

from neural_shadows.evaluation.soft_methods.moment_maps import moment_method
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.buffers import LIT
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.shadow_maps.box_filter import box_visibility
from neural_shadows.shadow_maps.light_filters import hard_visibility
from neural_shadows.shadow_maps.moments import gaussian, hamburger_visibility, powers

METHODS = {
    f"base_{name}": SoftMethod(channel=name, texel_floats=0, of_radius=False) for name in LIT
}
_MSM = moment_method(gaussian(3, 0.55), partial(powers, count=4), hamburger_visibility)


def base_by_map(name: str, frame: SoftFrame) -> np.ndarray:
    """One of `LIT`, (n,) float32, from the whole map, as buffers have it but for the map's depths."""
    looked_up = frame.light_map, frame.depths, frame.ways, frame.bias
    if name == "msm":
        found = _MSM.answer(frame, 0.0, bias=1.0, bleeding=0.0)
    elif name == "pcf":
        found = box_visibility(*looked_up[:3], frame.surface.n_g, frame.bias, size=1)
    else:
        found = hard_visibility(*looked_up)
    return np.where(frame.cosines > 0, found, np.float32(0))
