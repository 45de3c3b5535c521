"""Per-pixel features of screen-space networks: pure functions of buffers.

Symbols are the papers': z the distance from the light to the point seen, z_b (NSM's z) that to the
first surface in the map's texel, d the distance from the eye, c_e and c_v (NSM's c_c) the cosines of
the normal with the directions to light and eye. All are images (H, W) float32; lengths are in shares of
the scene's size S before they come here. Datta et al. 2022 (3.1), Hu et al. 2025 (4.1) and its code.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.frames.feature_names import BUFFERS, KPNSM_FEATURES, buffers_of
from neural_shadows.frames.kernel_features import kernel_feature
from neural_shadows.frames.light_size import LARGEST_STEP, LightSize
from neural_shadows.rendering.gbuffer import Lens

RATIO_SCALE, DIFFERENCE_SCALE = 200, 500  # what is 1 for `signed_log`: 1/200, and S/500
NEAREST = 0.05  # in shares of S: nearer points are as far in c_c / d


def named_features(
    names: Sequence[str], buffers: Mapping[str, np.ndarray], lens: Lens, light: LightSize
) -> np.ndarray:
    """Compute features, (C, H, W) float32 in their order, see `FEATURES`.

    Those of Kernel Predicting Neural Shadow Maps are as `kernel_feature` has them. Of Neural Shadow
    Mapping's the light's step is added to all of `c_e`, pixels without a surface included, which have 0
    elsewhere; c_e is cut off at 0 before, so that a whole step is distinguishable. `view`, `ratio` and
    `difference` are clipped where silhouettes and points close by would make them large.

    `ratio` − 1 and `difference` are signed logarithms, where the paper has them as they are: most of a
    frame is within 0.006 and 0.003 S of the map's surface, its shadows up to 100 times as far. After
    600 steps on 48 frames of the room, a network's squared errors (by light) are then 0.027 to 0.046
    instead of 0.041 to 0.071.

    Args:
        buffers: images (H, W) float32 by channel, of `frames.buffers`, in whose words z is NSM's z_f.
        lens: of the camera, for the same pixels.

    Raises:
        InputError: there is no such feature, or the buffers lack a channel.
    """
    if lacking := [buffer for buffer in buffers_of(names) if buffer not in buffers]:
        raise InputError(f"the features {', '.join(names)} need the buffer {', '.join(lacking)}")
    images = [image for name in names for image in _feature(name, buffers, lens, light)]
    return np.stack(images).astype(np.float32)


def _feature(
    name: str, buffers: Mapping[str, np.ndarray], lens: Lens, light: LightSize
) -> list[np.ndarray]:
    if name in KPNSM_FEATURES:
        return [kernel_feature(name, buffers, lens, light)]
    images = [buffers[buffer] for buffer in BUFFERS[name]]
    if name == "c_e":
        return [(np.clip(images[0], 0, 1) + light.step) / (LARGEST_STEP + 1)]
    if name == "view":
        return [np.clip(images[0] / np.maximum(images[1] * lens.axis, NEAREST), 0, 10)]
    if name == "ratio":
        beyond = images[1] / np.maximum(images[0], 1e-6)  # z / z_f − 1
        return [signed_log(RATIO_SCALE * np.clip(beyond, -1, 1))]
    if name == "difference":
        return [signed_log(DIFFERENCE_SCALE * np.clip(images[0], -2, 2))]
    if name == "d":
        return [images[0] * lens.axis]
    return [images[0] + images[1]] if name == "z" else images


def signed_log(x: np.ndarray) -> np.ndarray:
    """sign(x) log(1 + |x|): about x near 0, logarithmic far from it."""
    return np.copysign(np.log1p(np.abs(x)), x)
