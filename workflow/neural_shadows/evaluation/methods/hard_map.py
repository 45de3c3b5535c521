"""The plain shadow map: a binary test against one texel (Williams 1978)."""

from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import GREY, Look
from neural_shadows.evaluation.method import Method

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame

LOOK = Look("shadow map", GREY, "s", "■", "One test a pixel against the light map.")


def _visibility(frame: "SoftFrame", radius: float, *, bias: float) -> np.ndarray:
    from neural_shadows.shadow_maps.light_filters import hard_visibility

    biases = np.float32(bias) * frame.bias
    return hard_visibility(frame.light_map, frame.depths, frame.from_light, biases)


# Times the bias of a test against one texel, in finer steps than of filtered maps: a third of it, it and three
# times it left 369, 229 and 306 × 10⁻⁴ off edges of a point light, 0.6 of it 153 (validation frames of `windows`).
_BIASES = (0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.7, 3.0)
METHODS = {"hard": Method(_visibility, {"bias": _BIASES}, "Shadow map", null=True, of_radius=False)}
