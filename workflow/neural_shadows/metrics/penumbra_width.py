"""How wide the penumbrae of a frame are, on average along the edges of its hard shadows."""

import numpy as np

ENDS = (0.1, 0.9)  # visibilities between which 0.8 of a penumbra's width lies
# An edge of length 1 in a direction drawn at random crosses 4 / π sides of pixels (Cauchy, Crofton).
LENGTH_OF_A_SIDE = np.pi / 4


def penumbra_width(visibility: np.ndarray, valid: np.ndarray, hard: np.ndarray) -> float:
    """Mean width in pixels: the area between the ends over the length of the hard shadow's edges.

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
