"""Maps of depth's moments, filtered by a kernel of one width before they are looked up.

What VSM, EVSM and MSM have in common. Depth is the distance to the light over twice the scene's size.
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.shadow_maps.filtered_moments import filtered_moments
from neural_shadows.shadow_maps.light_filters import receiver_bias
from neural_shadows.shadow_maps.light_map import distances_of

# `bias`: times a cone's, which grows with the kernel: of a slanted receiver's own texels half lie
# before it. `bleeding`: visibilities up to it are made 0, and those above it stretched to [0, 1] again
# (Lauritzen 2007).
CONSTANTS = {"bias": (0.0, 0.03, 0.1, 0.3, 1.0), "bleeding": (0.0, 0.05, 0.1, 0.2, 0.3, 0.4)}


def moment_method(
    kernel: np.ndarray,
    of: Callable[[np.ndarray], np.ndarray],
    visibility: Callable[[np.ndarray, np.ndarray], np.ndarray],
) -> SoftMethod:
    """A method by moments `of` depths, (…) to (…, moments), whose `visibility` they bound.

    Args:
        kernel: weights of an odd number of texels along rows and columns.
        visibility: of moments (n, moments) and depths (n,), in [0, 1].
    """
    answer = partial(_answer, kernel=kernel, of=of, visibility=visibility)
    floats = of(np.zeros(1)).shape[-1]
    return SoftMethod(answer, CONSTANTS, texel_floats=floats, of_radius=False)


def _answer(
    frame: SoftFrame, radius: float, *, kernel, of, visibility, bias: float, bleeding: float
) -> np.ndarray:
    distances = distances_of(frame.ways)
    # A light far outside of the scene has receivers beyond.
    far = float(distances.max(initial=2 * frame.scene.size))
    moments = filtered_moments(
        frame.light_map, frame.depths, frame.ways, of=of, far=far, kernel=kernel
    )
    reach = 0.75 + _spread(kernel)
    cone = receiver_bias(frame.light_map, frame.ways, frame.cosines, frame.scene.size, reach)
    depth = np.maximum(distances - np.float32(bias) * cone, 0) / far
    found = (visibility(moments, depth) - bleeding) / (1 - bleeding)
    return np.maximum(found, 0).astype(np.float32)


def _spread(kernel: np.ndarray) -> float:
    """Standard deviation of a kernel's texels."""
    places = np.arange(len(kernel)) - len(kernel) // 2
    return float(np.sqrt(np.sum(kernel * places**2)))
