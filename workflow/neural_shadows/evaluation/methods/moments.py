"""Moments of depth, filtered by a fixed kernel before lookup.

Variance shadow maps: two moments, Chebyshev's bound (Donnelly and Lauritzen 2006); exponential ones
(Lauritzen and McCool 2008); four moments, Hamburger (Peters and Klein 2015). Depth is the distance
to the light over twice the scene's size, from the map's `near` on. Over the range of the frame's points VSM
9 × 9 erred 5 to 13 % less, MSM of 3 × 3 and 15 × 15 and MSSM from 2 % less to 3 % more (validation frames of
`windows`, three lights, biases and bleeding anew).
"""

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import YELLOW, Look
from neural_shadows.evaluation.method import Method

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame
    from neural_shadows.rendering.surface import Surface

LOOK = Look(
    "filtered moments (VSM, EVSM, MSM)",
    YELLOW,
    "^",
    "▲",
    "Blurs powers of depth before they are looked up.",
)

# Times a cone's bias, which grows with the kernel: half of a slanted receiver's texels lie before it.
BIAS = {"bias": (0.0, 0.03, 0.1, 0.3, 1.0, 3.0)}
BLEEDING = {"bleeding": (0.0, 0.05, 0.1, 0.2, 0.3, 0.4)}  # see `without_leaks`
_FLOATS = {"vsm": 2, "evsm": 4, "msm": 4}  # of a texel


def _visibility(
    frame: "SoftFrame",
    radius: float,
    *,
    kind: str,
    size: int,
    sigma: float | None,
    bias: float,
) -> np.ndarray:
    from neural_shadows.rendering.lengths import lengths_of
    from neural_shadows.shadow_maps import moments
    from neural_shadows.shadow_maps.filtered_moments import filtered_moments
    from neural_shadows.shadow_maps.light_filters import receiver_bias

    moments_of, bound = {
        "vsm": (partial(moments.powers, count=2), moments.variance_visibility),
        "evsm": (moments.warped, moments.exponential_visibility),
        "msm": (partial(moments.powers, count=4), moments.hamburger_visibility),
    }[kind]
    kernel = moments.box(size) if sigma is None else moments.gaussian(size, sigma)
    from_light = frame.from_light
    distances = lengths_of(from_light)
    # A light far outside the scene has receivers beyond this.
    near = frame.light_map.near
    farthest = float(distances.max(initial=2 * frame.scene.size))
    filtered = filtered_moments(
        frame.light_map, frame.depths, from_light, of=moments_of, far=farthest, kernel=kernel
    )
    reach = 0.75 + _spread(kernel)
    cone = receiver_bias(frame.light_map, from_light, frame.cosines, frame.scene.size, reach)
    nearer = distances - np.float32(near) - np.float32(bias) * cone
    return bound(filtered, np.maximum(nearer, 0) / (farthest - near)).astype(np.float32)


def without_leaks(surface: "Surface", shares: np.ndarray, *, bleeding: float) -> np.ndarray:
    """Visibilities (n,), of which those up to `bleeding` are 0 and those above fill [0, 1] (Lauritzen 2007)."""
    return np.maximum((shares - np.float32(bleeding)) / np.float32(1 - bleeding), np.float32(0))


def _spread(kernel: np.ndarray) -> float:
    """Standard deviation of a kernel's texels."""
    offsets = np.arange(len(kernel)) - len(kernel) // 2
    return float(np.sqrt(np.sum(kernel * offsets**2)))


def _method(kind: str, size: int, sigma: float | None = None) -> Method:
    """Moments filtered over size × size texels, odd.

    Args:
        sigma: of a Gaussian, in texels (Hu et al. 2025, 6.1); None for the mean, as in Datta et al.
            2022, who give sizes alone.
    """
    label = f"{kind.upper()} {size} × {size}" + (f", σ {sigma:g}" if sigma else "")
    visible = partial(_visibility, kind=kind, size=size, sigma=sigma)
    # One constant after the other, errors under a sun and a panel were up to 7 % larger.
    return Method(
        visible,
        BIAS | BLEEDING,
        label,
        joint=True,
        texel_floats=_FLOATS[kind],
        of_radius=False,
        last=without_leaks,
        of_last=(*BLEEDING,),
    )


METHODS = {
    "vsm_3": _method("vsm", 3),
    "vsm_9": _method("vsm", 9),
    "evsm_9": _method("evsm", 9),
    "msm_3": _method("msm", 3),
    "msm_9": _method("msm", 9),
    "msm_15": _method("msm", 15, sigma=3.0),
}
