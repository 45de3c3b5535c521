"""How much a sequence flickers: each frame beside the one before, moved to where its points are now.

A moving light changes shadows truly: the reference's own number says how much, and is to be shown
beside a method's. Blur lowers both: so is the error.
"""

from collections.abc import Sequence

import numpy as np

SHARPNESS = 3.0  # α of eq. 3 (Datta et al. 2022)


def exponential_instability(differences: Sequence[np.ndarray]) -> float:
    """E: mean of exp(3 |difference|) − 1 over all accepted pixels (Datta et al. 2022, eq. 3).

    Args:
        differences: of each pair of frames, the accepted pixels' (n,).

    Raises:
        ValueError: none was accepted.
    """
    together = _together(differences)
    return float(np.expm1(SHARPNESS * np.abs(together)).mean())


def root_instability(differences: Sequence[np.ndarray], pixels: int) -> float:
    """Root of the mean squared difference over all pixels, rejected ones 0 (Hu et al. 2025, eq. 7).

    Args:
        differences: as above; pixels: of a whole frame.
    """
    total = sum(float(np.square(one, dtype=np.float64).sum()) for one in differences)
    return float(np.sqrt(total / (len(differences) * pixels)))


def _together(differences: Sequence[np.ndarray]) -> np.ndarray:
    together = np.concatenate([np.ravel(one) for one in differences])
    if len(together) == 0:
        raise ValueError("instability: no pixel of any frame is seen in the one before")
    return together.astype(np.float64)
