"""The plain shadow map: a binary test against one texel (Williams 1978)."""

import numpy as np

from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.shadow_maps.light_filters import hard_visibility


def _answer(frame: SoftFrame, radius: float) -> np.ndarray:
    return hard_visibility(frame.light_map, frame.depths, frame.ways, frame.bias)


METHODS = {"hard": SoftMethod(_answer, of_radius=False)}
