"""Loss curves as `train` wrote them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from neural_shadows.files.broken import broken, reading
from neural_shadows.files.csv_file import read_csv

if TYPE_CHECKING:
    pass

COLUMNS = {"step": "int64", "samples": "int64", "learning_rate": "float64", "loss": "float64"}


def read_loss(path: str | Path) -> pd.DataFrame:
    """Read a training's loss curve: `step, samples, learning_rate, loss`, a row per point.

    Raises:
        InputError: the file is missing; or cut short or no loss curve, and moved aside.
    """
    with reading(path, "loss curve"):
        curve = read_csv(path, COLUMNS)
    if curve.empty or not np.isfinite(curve).all(axis=None):
        raise broken(path, "not a whole loss curve (a value is missing or not finite)")
    return curve
