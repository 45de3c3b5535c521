"""What screen-space methods are told of a pixel: pure functions of buffers.

Symbols are the papers': z the distance from the light to the point seen, z_b (NSM's z) that to the
first surface in the map's texel, d the distance from the eye, c_e and c_v (NSM's c_c) the cosines of
the normal with the ways to light and eye. All are images (H, W) float32; lengths are in shares of
the scene's size S before they come here. Datta et al. 2022 (3.1), Hu et al. 2025 (4.1) and its code.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from neural_shadows.errors import InputError

PENUMBRA_PIXELS = 50.0  # the widest that KPNSM's network is told apart
FULL_WIDTH = 2048  # pixels of the frame that it was made for …
FULL_FOCAL = 983.5  # … whose focal length is this many
LARGEST_STEP = 4  # NSM's index of the largest light: 50 cm across


def nsm_features(
    z: np.ndarray, z_b: np.ndarray, d: np.ndarray, c_e: np.ndarray, c_v: np.ndarray, step: float
) -> np.ndarray:
    """The four channels of Neural Shadow Mapping, (4, H, W) float32: c_e with the light's size, c_v / d,
    z_b / z and z_b − z.

    The step, 0 for a point to 4 for the largest light, is added to the whole first channel, pixels
    without a surface included; c_e is cut off at 0 before, so that a whole step can be told from it.

    Args:
        d: along the camera's axis.
    """
    size = (np.clip(c_e, 0, 1) + step) / (LARGEST_STEP + 1)
    view = np.clip(c_v / np.maximum(d, 0.05), 0, 10)
    ratio = np.clip(z_b / np.maximum(z, 1e-6), 0, 2)
    return np.stack([size, view, ratio, np.clip(z_b - z, -2, 2)]).astype(np.float32)


MAIN = ("c_e", "view", "ratio", "difference")


def named_features(
    names: Sequence[str], buffers: Mapping[str, np.ndarray], axis: np.ndarray, step: float
) -> np.ndarray:
    """The channels of these names, (C, H, W) float32; see `nsm_features`.

    Args:
        buffers: (H, W) float32 by the names of `buffers.CHANNELS`.
        axis: (H, W) float32, cosines of the pixels' ways with the camera's axis.
        step: 0 for a point to 4 for the largest light.

    Raises:
        InputError: a name that is no feature.
    """
    if unknown := [name for name in names if name not in MAIN]:
        raise InputError(f"features: {', '.join(unknown)}: not among {', '.join(MAIN)}")
    z = buffers["z"]
    found = nsm_features(
        z, z + buffers["gap"], buffers["d"] * axis, buffers["c_e"], buffers["c_v"], step
    )
    return found[[MAIN.index(name) for name in names]]


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


def penumbra_model(
    z: np.ndarray, nearest: np.ndarray, farthest: np.ndarray, radius: float
) -> np.ndarray:
    """Width of the penumbra that a sphere between two blockers' distances casts (Datta et al., 3.6).

    From the outer boundary to the umbra's, in the unit of the distances; 0 where nothing blocks.

    Args:
        z: from the light to the receiver; nearest, farthest: to the blockers on the way, NaN for none.
    """
    middle, half = (farthest + nearest) / 2, (farthest - nearest) / 2
    spread = np.arcsin(np.clip(half / np.hypot(middle, radius), 0, 1))
    angle = np.arctan(radius / middle)
    outer = z * np.tan(np.minimum(angle + spread, np.pi / 2 - 1e-3)) - radius
    inner = z * np.tan(angle - spread) - radius
    return np.nan_to_num(outer + inner, nan=0.0)
