"""Tables as CSV and Markdown."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from tabulate import tabulate

from neural_shadows.files.broken import reading
from neural_shadows.files.csv_file import read_csv
from neural_shadows.files.whole_files import write_text


def read_table(path: str | Path, texts: Sequence[str], numbers: Sequence[str]) -> pd.DataFrame:
    """Read the CSV of a table that `write_twins` wrote.

    Args:
        texts, numbers: columns that it must have; a cell may be empty, and is then NaN.

    Raises:
        InputError: the file is missing; or not whole or no such table, and moved aside.
    """
    kinds = dict.fromkeys(texts, "str") | dict.fromkeys(numbers, "float64")
    with reading(path, "table"):
        return read_csv(path, kinds, others=True)


def write_twins(
    frame: pd.DataFrame,
    columns: Mapping[str, Sequence[str]],
    csv_path: str | Path,
    md_path: str | Path,
    *,
    title: str,
    notes: Sequence[str],
    text_columns: int = 1,
) -> None:
    """Write a table as CSV (`frame`, all digits) and as its Markdown twin for reading.

    Args:
        columns: the Markdown's cells by heading.
        text_columns: how many columns from the left hold text; the others are aligned right.
        notes: one a line, below the table.
    """
    write_text(csv_path, frame.to_csv(index=False, float_format="%.6g"))
    table = tabulate(
        columns,
        headers="keys",
        tablefmt="pipe",
        disable_numparse=True,
        colalign=["left"] * text_columns + ["right"] * (len(columns) - text_columns),
    )
    items = "\n".join(f"- {note}" for note in notes)
    write_text(md_path, f"# {title}\n\n{table}\n\n{items}\n")


def thesis_texts(values: Iterable[float], decimals: int) -> list[str]:
    """Cells of printed numbers; empty where the thesis prints none."""
    return ["" if np.isnan(value) else f"{value:.{decimals}f}" for value in values]


def interval_text(value: float, low: float, high: float, decimals: int) -> str:
    """A cell: value [low, high], or `not available` for NaN."""
    if np.isnan(value):
        return "not available"
    return f"{value:.{decimals}f} [{low:.{decimals}f}, {high:.{decimals}f}]"
