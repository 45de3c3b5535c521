"""What screen-space networks and methods are told of a pixel: pure functions of buffers.

Symbols are the papers': z the distance from the light to the point seen, z_b (NSM's z) that to the
first surface in the map's texel, d the distance from the eye, c_e and c_v (NSM's c_c) the cosines of
the normal with the ways to light and eye. All are images (H, W) float32; lengths are in shares of
the scene's size S before they come here. Datta et al. 2022 (3.1), Hu et al. 2025 (4.1) and its code.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.frames.feature_names import FEATURES

PENUMBRA_PIXELS = 50.0  # the widest that KPNSM's network is told apart
FULL_WIDTH = 2048  # pixels of the frame that it was made for …
FULL_FOCAL = 983.5  # … whose focal length is this many
LARGEST_STEP = 4  # NSM's index of the largest light: 50 cm across
RATIO_SCALE, DIFFERENCE_SCALE = 200, 500  # what is 1 for `signed_log`: 1/200, and S/500
NEAREST = 0.05  # in shares of S: nearer points are as far in c_c / d

# The buffers of each of `FEATURES`: view is c_c / d, ratio z / z_f, difference z − z_f in NSM's symbols,
# and agreement n · n_e.
_MADE_OF = {
    "c_e": ("c_e",),
    "view": ("c_v", "d"),
    "ratio": ("z", "gap"),
    "difference": ("gap",),
    "agreement": ("agreement",),
    "d": ("d",),
    "n": ("n_x", "n_y", "n_z"),
    "z": ("z", "gap"),
    "n_e": ("e_x", "e_y", "e_z"),
    "z_f": ("z",),
    "c_c": ("c_v",),
}


def buffers_of(names: Sequence[str]) -> list[str]:
    """The buffers that features are made of, each once.

    Raises:
        InputError: there is no such feature.
    """
    for name in names:
        if name not in FEATURES:
            raise InputError(f"{name!r} is no feature; use some of {', '.join(FEATURES)}")
    return list(dict.fromkeys(buffer for name in names for buffer in _MADE_OF[name]))


def named_features(
    names: Sequence[str], buffers: Mapping[str, np.ndarray], axis: np.ndarray, step: float
) -> np.ndarray:
    """Features of Neural Shadow Mapping, (C, H, W) float32 in the order of their names, see `FEATURES`.

    The step is added to all of `c_e`, pixels without a surface included, which have 0 elsewhere;
    c_e is cut off at 0 before, so that a whole step can be told from it. `view`, `ratio` and
    `difference` are clipped where silhouettes and points close by would make them large.

    `ratio` − 1 and `difference` are signed logarithms, where the paper has them as they are: most of a
    frame is within 0.006 and 0.003 S of the map's surface, its shadows up to 100 times as far. After
    600 steps on 48 frames of the room, a network's squared errors (by light) are then 0.027 to 0.046
    instead of 0.041 to 0.071.

    Args:
        buffers: images (H, W) float32 by channel, of `frames.buffers`, in whose words z is NSM's z_f.
        axis: (H, W), see `axis_cosines`. step: 0 for a point to 4 for the largest light.

    Raises:
        InputError: there is no such feature, or the buffers lack a channel that one is made of.
    """
    if lacking := [one for one in buffers_of(names) if one not in buffers]:
        raise InputError(f"the features {', '.join(names)} need the buffer {', '.join(lacking)}")
    images = [image for name in names for image in _feature(name, buffers, axis, step)]
    return np.stack(images).astype(np.float32)


def _feature(name: str, buffers: Mapping[str, np.ndarray], axis: np.ndarray, step: float):
    of = [buffers[one] for one in _MADE_OF[name]]
    if name == "c_e":
        return [(np.clip(of[0], 0, 1) + step) / (LARGEST_STEP + 1)]
    if name == "view":
        return [np.clip(of[0] / np.maximum(of[1] * axis, NEAREST), 0, 10)]
    if name == "ratio":
        beyond = of[1] / np.maximum(of[0], 1e-6)  # z / z_f − 1
        return [signed_log(RATIO_SCALE * np.clip(beyond, -1, 1))]
    if name == "difference":
        return [signed_log(DIFFERENCE_SCALE * np.clip(of[0], -2, 2))]
    if name == "d":
        return [of[0] * axis]
    return [of[0] + of[1]] if name == "z" else of


def signed_log(x: np.ndarray) -> np.ndarray:
    """sign(x) log(1 + |x|): as x is near 0, as its logarithm is far from it."""
    return np.copysign(np.log1p(np.abs(x)), x)


def penumbra_pixels(
    z: np.ndarray,
    z_b: np.ndarray,
    d: np.ndarray,
    c_e: np.ndarray,
    c_v: np.ndarray,
    radius: float,
    focal: float,
) -> np.ndarray:
    """How wide a penumbra is in the frame, in pixels; 0 where nothing blocks (Hu et al. 2025, eq. 2, 3).

    With the distance d and the focal length that the paper leaves out and its code has.

    Args:
        radius: of the light, in shares of S. focal: of the camera, in pixels.
    """
    width = FULL_WIDTH * focal / FULL_FOCAL
    slant = np.sqrt(np.abs(c_v) / (np.abs(c_e) + 1e-5))
    blocked = (z - z_b) * radius / (z_b + 1e-5)
    return (blocked / np.maximum(d, 1e-5) * width * slant).astype(np.float32)


def kpnsm_features(
    z: np.ndarray,
    z_b: np.ndarray,
    d: np.ndarray,
    c_e: np.ndarray,
    c_v: np.ndarray,
    base: np.ndarray,
    radius: float,
    focal: float,
) -> np.ndarray:
    """The eight planes of Kernel Predicting Neural Shadow Maps, in its code's order, (8, H, W) float32.

    Args:
        d: the distance from the eye. base: the shadow that is filtered, 0 where c_e < 0.
    """
    pixels = penumbra_pixels(z, z_b, d, c_e, c_v, radius, focal)
    planes = [
        c_e,
        c_v / (d + 1e-10),
        z,
        np.clip(pixels, 0, PENUMBRA_PIXELS) / PENUMBRA_PIXELS,
        z - z_b,
        z_b / (z + 1e-10),
        z_b,
        base,
    ]
    return np.stack(planes).astype(np.float32)
