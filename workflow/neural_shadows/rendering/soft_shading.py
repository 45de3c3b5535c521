"""Grey pictures of a soft shadow from a frame's buffers."""

from typing import NamedTuple

import numpy as np

from neural_shadows.rendering.shading import AMBIENT, BACKGROUND

SKY_FROM_ABOVE = 0.5  # share of the sky's light that depends on the normal


class Shading(NamedTuple):
    """Grey levels of a frame's pixels, (height, width) float32 in [0, 1].

    Surfaces are grey: frames store no colour. The same of all methods, which differ in their
    visibility alone.
    """

    direct: np.ndarray  # by the whole light
    sky: np.ndarray  # without it

    def picture(self, visibility: np.ndarray) -> np.ndarray:
        """Shade visibility (height, width) in [0, 1]."""
        return self.sky + self.direct * visibility


def soft_shading(surface: np.ndarray, cosine: np.ndarray, upward: np.ndarray) -> Shading:
    """Shading of a grey Lambert surface under a light and a sky.

    (1 − AMBIENT) max(0, n·l) visibility, and AMBIENT of a sky that a floor sees whole, a wall to three
    quarters and a ceiling to half; BACKGROUND where there is no surface.

    Args:
        surface: (height, width) bool. cosine: n·l, `c_e` of a frame's buffers. upward: n·up, their
            `n_y`.
    """
    sky = AMBIENT * (1 - SKY_FROM_ABOVE * (1 - upward) / 2)
    direct = (1 - AMBIENT) * np.maximum(cosine, 0)
    return Shading(
        np.where(surface, direct, 0).astype(np.float32),
        np.where(surface, sky, BACKGROUND).astype(np.float32),
    )
