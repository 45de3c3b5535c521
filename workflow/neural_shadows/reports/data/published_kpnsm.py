"""The numbers that Hu et al. 2025 print (config/published_kpnsm.csv)."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.reports.data.published import by_cell

PAPER = "Hu et al. 2025"
# What the file's numbers are multiplied by, for our units.
UNITS: Mapping[str, float] = {"mse": 1e-4, "ssim": 1, "time": 1, "temporal_error": 1e-2}


def read_published_kpnsm(path: Path) -> pd.Series:
    """The printed numbers: a Series of values by (table, row, column), in the file's units."""
    return by_cell(pd.read_csv(path, dtype={"table": str, "value": float}))


def printed_value(
    published: pd.Series, table: str | None, row: str | None, column: str, metric: str
) -> float:
    """A metric in a cell of a table (`kpnsm.1`), in our units; NaN if none is printed."""
    if table is None or row is None:
        return np.nan
    key = (f"T{table.removeprefix('kpnsm.')}", row, column)
    return UNITS[metric] * published.get(key, np.nan)


def titled(title: str, table: str | None) -> str:
    """A table's heading with the paper's number of it."""
    return title if table is None else f"{title} (table {table.removeprefix('kpnsm.')} of {PAPER})"
