"""Loss curves of `train`."""

from pathlib import Path

import pandas as pd

COLUMNS = {"step": "int64", "samples": "int64", "learning_rate": "float64", "loss": "float64"}


def read_loss(path: Path) -> pd.DataFrame:
    """A training's loss curve, a row per point."""
    return pd.read_csv(path, usecols=list(COLUMNS), dtype=COLUMNS)
