"""Exact soft shadow at each pixel's centre: without antialiasing.

The targets are antialiased, over eight samples a pixel; methods see one. This row is the part of an
error due to that alone.
"""

from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import BLACK, Look
from neural_shadows.evaluation.soft_method import SoftMethod

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame

LOOK = Look(
    "the exact shadow",
    BLACK,
    "d",
    "◈",
    "A perfect shadow at each pixel's centre, without the antialiasing of the target.",
)

# Of each mixed pixel; as many as a target's eight samples have of one ring.
_SAMPLES = 128


def _visibility(frame: "SoftFrame", radius: float) -> np.ndarray:
    from neural_shadows.rendering.soft_shadows import soft_visibility

    surface = frame.surface
    images = soft_visibility(
        frame.scene,
        surface.camera,
        surface.width,
        surface.height,
        centre=frame.centre,
        radii=[radius],
        samples=_SAMPLES,
        surfaces=[surface],
    )
    return images[0].ravel()[surface.pixel]


METHODS = {
    "exact_centre": SoftMethod(
        _visibility, label="Exact at the pixel's centre", texel_floats=0, by_rays=True
    )
}
