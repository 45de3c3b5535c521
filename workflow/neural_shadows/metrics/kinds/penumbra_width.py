"""Widths of a frame's penumbrae, in pixels.

On average along edges of hard shadows, and pixel by pixel.
"""

import numpy as np

from neural_shadows.metrics.metric import Metric, Pixels

_WIDTH = {"unit": "pixels", "digits": 1, "better": None, "lights": ("soft",)}
METRICS = {
    "width": Metric("penumbra width", **_WIDTH),
    "width_reference": Metric("penumbra width", "of the reference", **_WIDTH),
}
ENDS = (0.1, 0.9)  # visibilities between which 0.8 of a penumbra's width lies
# An edge of length 1 in a direction drawn at random crosses 4 / π sides of pixels (Cauchy, Crofton).
LENGTH_OF_A_SIDE = np.pi / 4
_REACHES = (2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96)  # pixels, half of a width and more
WIDEST = 2 * _REACHES[-1]  # pixels: the largest width that is resolved


def of_visibility(visibility: np.ndarray, target: np.ndarray, pixels: Pixels) -> dict[str, float]:
    """`penumbra_width` of both; empty where the hard shadow is unknown."""
    if pixels.hard is None:
        return {}
    images = {"width": visibility, "width_reference": target}
    return {
        name: penumbra_width(image, pixels.valid, pixels.hard) for name, image in images.items()
    }


def penumbra_width(visibility: np.ndarray, valid: np.ndarray, hard: np.ndarray) -> float:
    """Mean width in pixels. The area between the ends over the length of the hard shadow's edges.

    NaN without an edge. Penumbrae that lie across several edges count once for all of them.

    Args:
        visibility, hard: (H, W) float32 in [0, 1], the latter of a point light; valid: (H, W) bool.
    """
    lit = hard > 0.5
    down = (lit[1:] != lit[:-1]) & valid[1:] & valid[:-1]
    along = (lit[:, 1:] != lit[:, :-1]) & valid[:, 1:] & valid[:, :-1]
    length = LENGTH_OF_A_SIDE * (down.sum() + along.sum())
    area = np.count_nonzero(valid & (visibility > ENDS[0]) & (visibility < ENDS[1]))
    return float(area / (ENDS[1] - ENDS[0]) / length) if length else float("nan")


def local_widths(visibility: np.ndarray, valid: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Penumbra width at each penumbra pixel, (n,) pixels. At most `WIDEST`.

    The whole width, from where the light begins to be hidden to where all of it is: that of a straight
    edge's penumbra as steep as the steepest pixel within half a width: of a spherical light, by 4 / π
    of its mean slope. From 5 pixels on, 3 % too wide, or with the noise of 512 rays up
    to 8 % too narrow; narrower ones by up to 2 pixels too wide. Where penumbrae cross, the steeper
    one's; of an occluder thinner than half the width, wider than the light alone would make it; near
    geometry edges, of the steepest pixel clear of them; pixels without one are left out.

    Args:
        visibility: (H, W) float32 in [0, 1], exact. valid: (H, W) bool. edges: (H, W) bool, pixels at
            geometry edges, where another surface's visibility begins.
    """
    from scipy.ndimage import gaussian_filter, maximum_filter, minimum_filter

    counts = valid & ~edges
    selected = counts & (visibility > ENDS[0]) & (visibility < ENDS[1])
    widths, remaining = np.full(visibility.shape, np.nan), selected.copy()
    for reach in _REACHES:
        if not remaining.any():
            break
        sigma = max(0.5, reach / 6)
        slope = np.hypot(*(gaussian_filter(visibility, sigma, order) for order in ((1, 0), (0, 1))))
        # Off other surfaces by most of the filter's support.
        clear = minimum_filter(counts, 2 * round(1.5 * sigma) + 1, mode="nearest")
        steepest = maximum_filter(np.where(clear, slope + 1e-6, 0), 2 * reach + 1)
        measured = remaining & (steepest > 0)
        widths[measured] = np.minimum(4 / np.pi / steepest[measured], WIDEST)
        remaining &= ~(widths <= 2 * reach)
    widths = widths[selected]
    return widths[~np.isnan(widths)]
