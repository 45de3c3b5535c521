"""Features of Kernel Predicting Neural Shadow Maps (Hu et al. 2025, 4.1, 6.2.5).

Its inputs, in the order of its code: cosine, c_v_by_d, z_f (its z), penumbra, behind, z_b_by_z, z_b,
and a base. `ray_penumbra` and `log_d` are ours. Its table 4 has `penumbra_pcss` or `r_e` in the penumbra's place, or Neural Shadow
Mapping's `c_e`, to which the light's size is added.
"""

from collections.abc import Mapping

import numpy as np

from neural_shadows.frames.feature_names import BASES
from neural_shadows.frames.light_size import LARGEST_STEP, LightSize
from neural_shadows.rendering.gbuffer import Lens

PENUMBRA_PIXELS = 50.0  # the widest distinguished
FULL_WIDTH = 2048  # pixels, of the paper's frames …
FULL_FOCAL = 983.5  # … and their focal length
_NEAREST = 1e-3  # in shares of the scene's size: nearer points are as far in `log_d`


def kernel_feature(
    name: str, buffers: Mapping[str, np.ndarray], lens: Lens, light: LightSize
) -> np.ndarray:
    """Compute a feature of `KPNSM_FEATURES`, (H, W), with the paper's scaling.

    `r_e` is 1 everywhere for the largest light.
    """
    if name in BASES:
        return buffers[name.removeprefix("base_")]
    if name == "cosine":
        return buffers["c_e"]
    if name == "c_v_by_d":
        return buffers["c_v"] / (buffers["d"] + 1e-10)
    if name == "r_e":
        return np.full_like(buffers["z"], light.step / LARGEST_STEP)
    if name == "log_d":
        return np.log(np.maximum(buffers["d"], _NEAREST))
    if name == "ray_penumbra":
        blurred = np.maximum(buffers["ray_penumbra"], 0)
        return _shown(frame_pixels(blurred, *(buffers[b] for b in ("d", "c_e", "c_v")), lens.focal))
    z, z_b = buffers["z"], blocker(buffers)
    if name == "behind":
        return z - z_b
    if name == "z_b_by_z":
        return z_b / (z + 1e-10)
    if name == "z_b":
        return z_b
    slant = (buffers["c_e"], buffers["c_v"]) if name == "penumbra" else (1.0, 1.0)
    return _shown(penumbra_pixels(z, z_b, buffers["d"], *slant, light, lens.focal))


def _shown(pixels: np.ndarray) -> np.ndarray:
    return np.clip(pixels, 0, PENUMBRA_PIXELS) / PENUMBRA_PIXELS


def blocker(buffers: Mapping[str, np.ndarray]) -> np.ndarray:
    """z_b (H, W): distances from the light to blockers, or to lit points.

    As in the authors' frames. With the texel as it is, slanted surfaces would hide themselves.
    """
    lit = buffers["hard"] > 0.5
    return buffers["z"] + np.where(lit, 0, np.minimum(buffers["gap"], 0))


def penumbra_pixels(
    z: np.ndarray,
    z_b: np.ndarray,
    d: np.ndarray,
    c_e: np.ndarray | float,
    c_v: np.ndarray | float,
    light: LightSize,
    focal: float,
) -> np.ndarray:
    """Penumbra widths in pixels, 0 without blockers (Hu et al. 2025, eq. 2, 3).

    With the distance d and the focal length of its code, which the paper leaves out.

    Args:
        z, z_b: see `frames.buffers`, of a sun without its distance. focal: of the camera, in pixels.
    """
    blurred = (z - z_b) * light.share / (z_b + light.away + 1e-5)
    return frame_pixels(blurred, d, c_e, c_v, focal)


def frame_pixels(
    blurred: np.ndarray,
    d: np.ndarray,
    c_e: np.ndarray | float,
    c_v: np.ndarray | float,
    focal: float,
) -> np.ndarray:
    """Widths in the frame, in pixels, of penumbrae of radii in shares of the scene's size."""
    width = FULL_WIDTH * focal / FULL_FOCAL
    slant = np.sqrt(np.abs(c_v) / (np.abs(c_e) + 1e-5))
    return (blurred / np.maximum(d, 1e-5) * width * slant).astype(np.float32)
