"""The exact soft shadow at the middle of each pixel: the best of one place a pixel.

The targets are antialiased, over eight places a pixel; methods see one. This row says how much of an
error is that of the place alone.
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
    "What a perfect answer at the middle of each pixel still lacks of the antialiased target.",
)

# Of each mixed pixel; as many as a target's eight places have of one ring.
_SAMPLES = 128


def _visibility(frame: "SoftFrame", radius: float) -> np.ndarray:
    from neural_shadows.rendering.soft_shadows import soft_visibility

    surface = frame.surface
    visible = soft_visibility(
        frame.scene,
        surface.camera,
        surface.width,
        surface.height,
        centre=frame.centre,
        radii=[radius],
        samples=_SAMPLES,
        surfaces=[surface],
    )
    return visible[0].ravel()[surface.pixel]


METHODS = {
    "exact_centre": SoftMethod(
        _visibility, label="Exact at the pixel's centre", texel_floats=0, by_rays=True
    )
}
