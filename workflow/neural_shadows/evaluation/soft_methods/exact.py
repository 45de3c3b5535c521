"""The exact soft shadow at the middle of each pixel: what no answer at one place a pixel can better.

The targets are antialiased, over eight places a pixel; methods see one. This row says how much of an
error is that of the place alone.
"""

import numpy as np

from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.soft_shadows import soft_visibility

# Each of a mixed pixel; as many as a target's eight places have of one ring.
_SAMPLES = 128


def _answer(frame: SoftFrame, radius: float) -> np.ndarray:
    surface = frame.surface
    visibility = soft_visibility(
        frame.scene,
        surface.camera,
        surface.width,
        surface.height,
        centre=frame.centre,
        radii=[radius],
        samples=_SAMPLES,
        surfaces=[surface],
    )
    return visibility[0].ravel()[surface.pixel]


METHODS = {"exact_centre": SoftMethod(_answer, texel_floats=0, by_rays=True)}
