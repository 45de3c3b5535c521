"""Flicker of a sequence, from consecutive frames.

Each frame is compared with the one before, reprojected to where its points are now. A moving light
does change shadows: the reference's own instability is shown beside a method's. Blur lowers
instability: the error is shown as well.
"""

from collections.abc import Sequence

import numpy as np

from neural_shadows.metrics.metric import Metric

METRICS = {
    "instability": Metric("flicker E", digits=3, lights=("soft",)),
    "temporal_error": Metric(
        "temporal error", unit="× 10⁻²", factor=100, digits=2, lights=("soft",)
    ),
}
SHARPNESS = 3.0  # α of eq. 3 (Datta et al. 2022)


def of_changes(changes: Sequence[np.ndarray], pixels: int) -> dict[str, float]:
    return {
        "instability": exponential_instability(changes),
        "temporal_error": root_instability(changes, pixels),
    }


def exponential_instability(differences: Sequence[np.ndarray]) -> float:
    """Mean of exp(3 |difference|) − 1 over all accepted pixels. E of Datta et al. 2022, eq. 3.

    Args:
        differences: of each pair of frames, the accepted pixels' (n,).

    Raises:
        ValueError: none was accepted.
    """
    differences = _joined(differences)
    return float(np.expm1(SHARPNESS * np.abs(differences)).mean())


def root_instability(differences: Sequence[np.ndarray], pixels: int) -> float:
    """Root mean squared difference over all pixels.

    Rejected pixels count as 0 (Hu et al. 2025, eq. 7).

    Args:
        differences: as above; pixels: of a whole frame.
    """
    total = sum(float(np.square(frame, dtype=np.float64).sum()) for frame in differences)
    return float(np.sqrt(total / (len(differences) * pixels)))


def _joined(differences: Sequence[np.ndarray]) -> np.ndarray:
    joined = np.concatenate([np.ravel(frame) for frame in differences])
    if len(joined) == 0:
        raise ValueError("instability: no pixel of any frame is visible in the previous one")
    return joined.astype(np.float64)
