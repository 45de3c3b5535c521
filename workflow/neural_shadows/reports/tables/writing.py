"""Tables as CSV and Markdown."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from tabulate import tabulate

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import write_text
from neural_shadows.running.origin import describe_origin


def read_table(path: Path, texts: Sequence[str], numbers: Sequence[str]) -> pd.DataFrame:
    """The named columns of a CSV that `write_twins` wrote; an empty cell is NaN.

    Raises:
        InputError: it has no such columns.
    """
    kinds = dict.fromkeys(texts, str) | dict.fromkeys(numbers, float)
    try:
        return pd.read_csv(path, usecols=list(kinds), dtype=kinds)
    except ValueError as error:
        raise InputError(f"{path}: damaged ({error}); delete it and run again") from error


def write_twins(
    frame: pd.DataFrame,
    columns: Mapping[str, Iterable[str]],
    csv: Path,
    md: Path,
    *,
    title: str,
    notes: Sequence[str],
    lead: str = "",
    text_columns: int = 1,
) -> None:
    """Write a table as CSV (`frame`, all digits) and as its Markdown twin for reading.

    Args:
        columns: the Markdown's cells by heading.
        lead: Markdown between the title and the table: what must be known to read it.
        text_columns: how many columns from the left hold text; the others are aligned right.
        notes: one a line, below the table.
    """
    write_text(csv, frame.to_csv(index=False, float_format="%.6g"))
    table = tabulate(
        {_escaped(heading): [*map(_escaped, cells)] for heading, cells in columns.items()},
        headers="keys",
        tablefmt="pipe",
        disable_numparse=True,
        colalign=["left"] * text_columns + ["right"] * (len(columns) - text_columns),
    )
    items = "\n".join(f"- {note}" for note in notes)
    origin = describe_origin()
    # Not a note: of each table on the page it would be another.
    made = f"<!-- commit {origin['commit']}, code {origin['code']}, {origin['machine']['cpu']} -->"
    parts = [f"# {title}", lead, table, items, made]
    write_text(md, "\n\n".join(part for part in parts if part) + "\n")


def _escaped(cell: str) -> str:
    """A cell as Markdown has it: a bar of its text would end it, a line's end its row."""
    return cell.replace("|", "\\|").replace("\n", "; ")


def number_cells(
    values: Iterable[float], form: str | Callable[[float], str], factor: float = 1
) -> list[str]:
    """Cells of numbers in a format, `{:.2f}`, or by a function; empty for NaN."""
    text = form.format if isinstance(form, str) else form
    return ["" if np.isnan(value) else text(value * factor) for value in values]


def interval_cells(
    table: pd.DataFrame, columns: Sequence[str], decimals: int, factor: float = 1
) -> list[str]:
    """Cells of a value and the ends of its interval, three columns, if it has one; empty for NaN."""
    triples = table[list(columns)].to_numpy(float) * factor
    values = number_cells(triples[:, 0], f"{{:.{decimals}f}}")
    form = f" [{{:.{decimals}f}}, {{:.{decimals}f}}]"
    ends = ["" if np.isnan(pair).any() else form.format(*pair) for pair in triples[:, 1:]]
    return [value + interval for value, interval in zip(values, ends)]
