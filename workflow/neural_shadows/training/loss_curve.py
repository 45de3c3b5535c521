"""Loss curves as `train` wrote them."""

from pathlib import Path

import pandas as pd

from neural_shadows.errors import InputError

COLUMNS = {"step": "int64", "samples": "int64", "learning_rate": "float64", "loss": "float64"}


def read_loss(path: Path) -> pd.DataFrame:
    """A training's loss curve, a row per point; InputError if the file is damaged."""
    try:
        return pd.read_csv(path, usecols=list(COLUMNS), dtype=COLUMNS)
    except ValueError as error:
        raise InputError(f"{path}: damaged ({error}); delete it and run again") from error
