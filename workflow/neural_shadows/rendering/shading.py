"""The exact shadow of a frame, and the grey picture made of an answer."""

import numpy as np

from neural_shadows.rendering.gbuffer import ShadingPoints
from neural_shadows.scenes.tracing import Tracer

AMBIENT = 0.25
BACKGROUND = 0.9


def reference_visibility(tracer: Tracer, points: ShadingPoints) -> np.ndarray:
    """Exact `lit` (m,) bool: an occlusion ray towards the light from each facing point."""
    towards = np.tile(points.light.astype(np.float32), (len(points.p), 1))
    return ~tracer.occluded(points.p, towards)


def visibility(points: ShadingPoints, lit: np.ndarray) -> np.ndarray:
    """Visibility of the light at all n surface points, (n,) bool, from `lit` (m,) at the facing."""
    visible = np.zeros(len(points.pixel), bool)
    visible[points.facing] = lit
    return visible


def shade(points: ShadingPoints, lit: np.ndarray) -> np.ndarray:
    """Grey Lambert picture, (height, width) float32 in [0, 1] [4.1].

    AMBIENT + (1 − AMBIENT) max(0, n·l) visibility, and BACKGROUND where there is no surface.
    """
    image = np.full(points.height * points.width, BACKGROUND, np.float32)
    image[points.pixel] = AMBIENT
    shown = points.facing[lit]
    image[points.pixel[shown]] += np.float32(1 - AMBIENT) * points.cosine[lit]
    return image.reshape(points.height, points.width)
