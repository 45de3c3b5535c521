"""The numbers that the thesis prints in its tables 4.1 to 4.7 (config/published.csv)."""

from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.files.csv_file import read_csv

COLUMNS = ("table", "row", "label", "column", "value", "unit", "section")


def read_published(path: str | Path) -> pd.DataFrame:
    """Read the printed numbers: one line per table, row and column.

    `row` is the pipeline's key of the method, `label` the thesis's printed name of it, `value`
    is in `unit`, `section` the thesis's section. Values are as printed, save two shadow maps of
    table 4.7: their 256 and 64 KiB are 0.25 and 0.0625 MiB, so that the column has one unit.

    Raises:
        InputError: the file cannot be read, has other columns, a value that is no number, or
            the same table, row and column twice.
    """
    try:
        published = read_csv(path, dict.fromkeys(COLUMNS, "str") | {"value": "float64"})
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error}): restore it from git") from error
    finite = np.isfinite(published["value"])
    if not finite.all():
        line = finite.argmin() + 2
        raise InputError(f"{path}: line {line} has no value: restore it from git")
    twice = published.duplicated(["table", "row", "column"])
    if twice.any():
        table, row, column = published.loc[twice, ["table", "row", "column"]].iloc[0]
        raise InputError(f"{path}: table {table}, {row}, {column} is there twice: remove one")
    return published


def printed(published: pd.DataFrame, table: str, row: str, column: str) -> float:
    """The number printed in `table` ("4.3") for `row` and `column`; NaN where none is printed."""
    found = published.query("table == @table and row == @row and column == @column")["value"]
    return float(found.iloc[0]) if len(found) else float("nan")
