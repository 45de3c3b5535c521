"""Metrics per view as `evaluate` wrote them."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.files.broken import broken, reading
from neural_shadows.files.csv_file import read_csv

METRICS_DTYPES = {
    "view": "int64",
    "view_set": "str",
    "method": "str",
    "metric": "str",
    "value": "float64",
}


def read_metrics(paths: Iterable[str | Path]) -> pd.DataFrame:
    """Read and join per-view metrics: a row per view, view set, method and metric.

    Columns: `view` (int), `view_set`, `method`, `metric`, `value` (float, finite), and `file`,
    the path that the row came from.

    Raises:
        InputError: a file is missing, cut short or not one of metrics (it is then moved aside),
            or repeats what it or an earlier one holds.
    """
    metrics = pd.concat([_read_one(path) for path in paths], ignore_index=True)
    twice = metrics.duplicated(["view", "view_set", "method", "metric"])
    if twice.any():
        row = metrics[twice].iloc[0]
        raise InputError(
            f"{row['file']}: {row['metric']} of {row['method']} in {row['view_set']} view "
            f"{row['view']} was given before: delete the file and run again"
        )
    return metrics


def _read_one(path: str | Path) -> pd.DataFrame:
    with reading(path, "file of metrics"):
        metrics = read_csv(path, METRICS_DTYPES)
    if metrics.empty or metrics.isna().any(axis=None):
        raise broken(path, "metrics are cut short")
    if not np.isfinite(metrics["value"]).all():
        raise broken(path, "a value is not finite")
    return metrics.assign(file=str(path))
