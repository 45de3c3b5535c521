"""Exact shadows of a sun, and of lights at pixels' centres.

The former is the reference of all views. The targets of frames are antialiased, over eight samples a
pixel; methods see one. The latter's row is the part of an error due to that alone.
"""

from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import BLACK, Look
from neural_shadows.evaluation.method import Method, OfBias, whatever_bias

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame
    from neural_shadows.rendering.gbuffer import GBuffer
    from neural_shadows.scenes.scene import Scene

LOOK = Look(
    "the exact shadow",
    BLACK,
    "d",
    "◈",
    "A perfect shadow at each pixel's centre, without the antialiasing of the target.",
)

_SAMPLES = 128  # of each mixed pixel: twice as many as a target of `measured: 8` has of one ring
_SALT = 1 << 25  # other random numbers than the target's, and than those of few rays


def _visibility(frame: "SoftFrame", radius: float) -> np.ndarray:
    from neural_shadows.rendering.soft_shadows import soft_visibility

    surface = frame.surface
    images = soft_visibility(
        frame.scene,
        surface.camera,
        surface.width,
        surface.height,
        centre=frame.centre,
        shape=frame.shape,
        radii=[radius],
        samples=_SAMPLES,
        surfaces=[surface],
        salt=_SALT,
    )
    return images[0].ravel()[surface.pixel]


def _traced(frame: "GBuffer", scene: "Scene", *, whole_map: bool = False) -> OfBias:
    from neural_shadows.rendering.exact_shadow import exact_visibility

    return whatever_bias(exact_visibility(scene.tracer, frame))


METHODS = {
    "ray_traced": Method(sun=_traced, label="Ray traced", exact=True),
    "exact_centre": Method(
        _visibility, label="Exact at the pixel's centre", texel_floats=0, by_rays=True
    ),
}
