"""Grey pictures of a frame's visibility [4.1]."""

import numpy as np

from neural_shadows.rendering.gbuffer import GBuffer

AMBIENT = 0.25
BACKGROUND = 0.9


def shade(frame: GBuffer, visibility: np.ndarray) -> np.ndarray:
    """Shade a grey Lambert picture, (height, width) float32 in [0, 1].

    AMBIENT + (1 − AMBIENT) max(0, n·l) visibility, and BACKGROUND where there is no surface.

    Args:
        visibility: (n,) float32 in [0, 1] of the frame's surface points.
    """
    image = np.full(frame.height * frame.width, BACKGROUND, np.float32)
    image[frame.pixel] = AMBIENT
    lambert = np.float32(1 - AMBIENT) * frame.cos_shading
    image[frame.pixel[frame.lit_side]] += lambert * visibility[frame.lit_side]
    return image.reshape(frame.height, frame.width)
