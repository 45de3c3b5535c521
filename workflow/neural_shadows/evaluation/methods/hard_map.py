"""The plain shadow map: a binary test against one texel (Williams 1978)."""

from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import GREY, Look
from neural_shadows.evaluation.method import Method

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame

LOOK = Look("shadow map", GREY, "s", "■", "One test a pixel against the light map.")


def _visibility(frame: "SoftFrame", radius: float) -> np.ndarray:
    from neural_shadows.shadow_maps.light_filters import hard_visibility

    return hard_visibility(frame.light_map, frame.depths, frame.from_light, frame.bias)


# Without a constant: with a third of its depth bias, errors off edges were 1.1 to 5 times as large, with three
# times it 1.02 to 1.3 times, under the lights of `frames` and of `windows` (first test frames of nine scenes).
METHODS = {"hard": Method(_visibility, label="Shadow map", null=True, of_radius=False)}
