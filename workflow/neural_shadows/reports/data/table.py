"""A table: numbers, formatted columns and notes."""

import json as json_text
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from tabulate import tabulate

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import write_text
from neural_shadows.reports.data.phrases import describe_run, titled
from neural_shadows.running.bundles import argument_types, call
from neural_shadows.running.provenance import describe_provenance, provenance_line

PARTING = ("scene", "light")  # first columns that part a table
BETTER = {"↑": "high", "↓": "low"}  # by the end of a heading


@dataclass(frozen=True)
class Column:
    """A formatted column.

    Args:
        texts: a text a row, empty where there is nothing.
        values: the numbers that the texts show, NaN where there is none; None of a column of text.
        intervals: the texts of their intervals, ` [low, high]`; ends: their ends, (n, 2).
        printed_of: the heading of the measured column beside it.
        comparable: true if printed numbers can share its scale.
        labels: of a column of methods their names, without what the texts add.
    """

    texts: Sequence[str]
    values: Sequence[float] | None = None
    intervals: Sequence[str] | None = None
    ends: np.ndarray | None = None
    printed_of: str = ""
    comparable: bool = True
    labels: Sequence[str] | None = None

    @property
    def cells(self) -> list[str]:
        """The texts with their intervals."""
        return [a + b for a, b in zip(self.texts, self.intervals or [""] * len(self.texts))]


@dataclass(frozen=True)
class Table:
    """A table.

    Args:
        data: the CSV, all digits.
        columns: formatted, by heading; plain texts are a `Column` of text.
        notes: one a line, below the table; of inline Markdown.
        title: by default the configured one, with the number in its text.
        lead: Markdown between the title and the table.
        text_columns: number of text columns from the left; the others are aligned right.
    """

    data: pd.DataFrame
    columns: Mapping[str, Column | Iterable[str]]
    notes: Sequence[str]
    title: str = ""
    lead: str = ""
    text_columns: int = 1

    def shown(self) -> dict[str, Column]:
        """The columns by heading."""
        return {
            heading: column if isinstance(column, Column) else Column([*column])
            for heading, column in self.columns.items()
        }


def whole_table(function: Callable[..., Table]) -> Callable[..., Table]:
    """A function of a table with title, scale and its note."""

    def table(**arguments: Any) -> Table:
        result, run = call(function, arguments), arguments["run"]
        scaled = result.data if "scale" in result.data else result.data.assign(scale=run["scale"])
        return replace(
            result,
            title=result.title or titled(arguments["title"], arguments["published"]),
            data=scaled,
            notes=[*result.notes, describe_run(run)],
        )

    table.__annotations__ = argument_types(function)
    return table


def write_table(table: Table, csv: Path, md: Path, json: Path) -> None:
    """Write a table as CSV, as Markdown for reading, and as JSON for the page."""
    columns = table.shown()
    write_text(csv, table.data.to_csv(index=False, float_format="%.6g"))
    text = tabulate(
        {_escaped(heading): [*map(_escaped, column.cells)] for heading, column in columns.items()},
        headers="keys",
        tablefmt="pipe",
        disable_numparse=True,
        colalign=["left"] * table.text_columns + ["right"] * (len(columns) - table.text_columns),
    )
    items = "\n".join(f"- {note}" for note in table.notes)
    provenance = describe_provenance()
    # Not a note: it differs by table, and the page shows equal notes once.
    made = f"<sub>{provenance_line(provenance)}</sub>"
    parts = [f"# {table.title}", table.lead, text, items, made]
    write_text(md, "\n\n".join(part for part in parts if part) + "\n")
    record = {
        "title": table.title,
        "parted": [*columns][0] in PARTING,
        "columns": [_as_json(heading, column) for heading, column in columns.items()],
        "notes": [*table.notes],
        "provenance": provenance,
    }
    write_text(json, json_text.dumps(record, ensure_ascii=False, indent=1) + "\n")


def _as_json(heading: str, column: Column) -> dict[str, Any]:
    record = {"heading": heading, "better": BETTER.get(heading[-1:]), "texts": [*column.texts]}
    if column.values is not None:
        ends = column.ends
        triples = [
            [value, *(ends[i] if ends is not None else (np.nan, np.nan))]
            for i, value in enumerate(column.values)
        ]
        record["values"] = [[_number(one) for one in three] for three in triples]
    for name in ("intervals", "labels"):
        if getattr(column, name) is not None:
            record[name] = [*getattr(column, name)]
    if column.printed_of:
        record["printed_of"] = column.printed_of
    if not column.comparable:
        record["comparable"] = False
    return record


def _number(value: float) -> float | None:
    """A number as JSON has it: six digits, none for NaN."""
    return float(f"{value:.6g}") if np.isfinite(value) else None


def _escaped(cell: str) -> str:
    """A cell as Markdown has it: a bar of its text would end it, a line's end its row."""
    return cell.replace("|", "\\|").replace("\n", "; ")


def read_table(path: Path, texts: Sequence[str], numbers: Sequence[str]) -> pd.DataFrame:
    """Read the named columns of a table's CSV; an empty cell is NaN.

    Raises:
        InputError: it has no such columns.
    """
    kinds = dict.fromkeys(texts, str) | dict.fromkeys(numbers, float)
    try:
        return pd.read_csv(path, usecols=list(kinds), dtype=kinds)
    except ValueError as error:
        raise InputError(f"{path}: damaged ({error}); delete it and run again") from error


def filled(columns: Mapping[str, Column | Iterable[str]]) -> dict[str, Column | Iterable[str]]:
    """The columns with any text."""
    return {
        heading: column
        for heading, column in columns.items()
        if any(column.cells if isinstance(column, Column) else column)
    }


def number_cells(
    values: Iterable[float], form: str | Callable[[float], str], factor: float = 1
) -> list[str]:
    """Texts of numbers in a format, `{:.2f}`, or by a function; empty for NaN, a rounded 0 without a sign."""
    text = re.sub(r"{:\+?", r"\g<0>z", form, count=1).format if isinstance(form, str) else form
    return ["" if np.isnan(value) else text(value * factor) for value in values]


def numbers(
    values: Iterable[float],
    form: str | Callable[[float], str],
    factor: float = 1,
    printed_of: str = "",
) -> Column:
    """A column of numbers in a format, `{:.2f}`, or by a function; empty for NaN."""
    values = np.asarray([*values], float)
    texts = number_cells(values, form, factor)
    return Column(texts, values * factor, printed_of=printed_of)


def with_ends(name: str) -> list[str]:
    """The columns of a value and of the ends of its interval."""
    return [name, f"{name}_low", f"{name}_high"]


def intervals(
    table: pd.DataFrame, columns: Sequence[str], decimals: int, factor: float = 1, sign: str = ""
) -> Column:
    """A column of values with their intervals: three columns of a table; empty for NaN.

    `sign`: "+" to show that of a positive value.
    """
    triples = table[list(columns)].to_numpy(float) * factor
    values = number_cells(triples[:, 0], f"{{:{sign}.{decimals}f}}")
    form = f" [{{:z.{decimals}f}}, {{:z.{decimals}f}}]"
    ends = ["" if np.isnan(pair).any() else form.format(*pair) for pair in triples[:, 1:]]
    return Column(values, triples[:, 0], ends, triples[:, 1:])
