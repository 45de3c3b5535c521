"""Tables of the page: cells with printed numbers, best values and dots."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from neural_shadows.evaluation.look import Look
from neural_shadows.evaluation.null_predictors import NULL
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.data.method_look import LOOKS
from neural_shadows.reports.data.published import NETWORKS
from neural_shadows.reports.page.blocks import Block, csv_file, inline, made_line

LOGARITHMIC = 20  # times the smallest: values so far apart are drawn so
DRAWN = 82  # width of a cell's drawing, px
NEVER_BEST = (*NETWORKS.values(), *NULL.values())
NAN = float("nan")


@dataclass
class Cell:
    """A cell of ours, and the printed number beside it.

    Args:
        numbers: the value, the ends of its interval, and the printed number; NaN if missing.
        places: of `numbers` in the cell's drawing, px from the left; None without a drawing.
    """

    text: str
    interval: str = ""
    theirs: str = ""
    numbers: list[float] = field(default_factory=lambda: [NAN] * 4)
    best: bool = False
    places: Sequence[float] | None = None

    @property
    def html(self) -> Markup:
        """The text without the interval."""
        return inline(self.text)


@dataclass(frozen=True)
class Part:
    """A table of one scene or light.

    Args:
        scene: empty in a table without parts.
        rows: the first cell is a method; looks: of the methods, None of an unknown one.
        logarithmic: headings of columns drawn with a logarithmic scale.
    """

    scene: str
    heads: list[str]
    rows: list[tuple[Cell, ...]]
    looks: list[Look | None]
    logarithmic: list[str]


def table_block(path: Path, looks: Mapping[str, Look]) -> Block:
    """A table, in a part for each scene or light; `looks` of methods by label."""
    table = read_json(path)
    columns = table["columns"]
    count = len(columns[0]["texts"])
    parts = {"": range(count)}
    if table["parted"]:  # a part may be named in its first row alone
        parts, name = {}, ""
        for row, text in enumerate(columns[0]["texts"]):
            name = text or name
            parts.setdefault(name, []).append(row)
        columns = columns[1:]
    return Block(
        "table",
        path.stem,
        table["title"],
        parts=[_part(name, columns, rows, looks) for name, rows in parts.items()],
        notes=tuple(map(inline, table["notes"])),
        files=csv_file(path.with_suffix(".csv")),
        made=made_line(table.get("provenance", {})),
    )


def shown_looks(blocks: Iterable[Block]) -> list[Look]:
    """Looks used by tables, each once, in the tables' order."""
    looks = (look for block in blocks for part in block.parts for look in part.looks)
    return [*filter(None, dict.fromkeys(looks))]


def has_printed(block: Block) -> bool:
    """Check a table for printed numbers beside ours."""
    return any(cell.theirs for part in block.parts for row in part.rows for cell in row)


def _part(
    scene: str,
    columns: Sequence[Mapping[str, Any]],
    rows: Sequence[int],
    looks: Mapping[str, Look],
) -> Part:
    """Build a part, with printed columns merged into ours and without empty ones."""
    shown: dict[str, tuple[Mapping[str, Any], list[Cell]]] = {}
    for column in columns:
        cells = [_cell(column, row) for row in rows]
        if column.get("printed_of") in shown:
            for cell, printed in zip(shown[column["printed_of"]][1], cells):
                cell.theirs, cell.numbers[3] = printed.text, printed.numbers[0]
        elif any(cell.text for cell in cells):
            shown[column["heading"]] = column, cells
    (first, _), *others = shown.values()
    labels = first.get("labels", first["texts"])
    names = [labels[row] for row in rows]
    printed = [name in NETWORKS.values() for name in names]
    logarithmic = []
    for column, cells in others:
        candidates = [cell for name, cell in zip(names, cells) if name not in NEVER_BEST]
        _mark_best(column["better"], candidates)
        if _place(cells, printed, column.get("comparable", True)):
            logarithmic.append(column["heading"])
    looks = looks | dict.fromkeys(NETWORKS.values(), LOOKS["frequency"])
    cells = zip(*(cells for _, cells in shown.values()))
    return Part(scene, [*shown], [*cells], [looks.get(name) for name in names], logarithmic)


def _cell(column: Mapping[str, Any], row: int) -> Cell:
    numbers = [NAN] * 4
    if "values" in column:
        numbers = [NAN if number is None else number for number in column["values"][row]] + [NAN]
    interval = column["intervals"][row] if "intervals" in column else ""
    return Cell(column["texts"][row], interval, numbers=numbers)


def _mark_best(better: str | None, cells: Sequence[Cell]) -> None:
    sign = {"high": 1, "low": -1}.get(better, NAN)
    values = np.array([cell.numbers[0] for cell in cells]) * sign
    if np.isfinite(values).sum() > 1:
        for cell, value in zip(cells, values):
            cell.best = bool(value == np.nanmax(values))


def _place(cells: Sequence[Cell], printed: Sequence[bool], comparable: bool) -> bool:
    """Place the numbers of a column with intervals or printed numbers.

    Args:
        printed: the rows of the thesis's own values, which are drawn as its numbers are.
        comparable: true if printed numbers can share our scale.

    Returns: true for a logarithmic scale.
    """
    drawn = np.array([cell.numbers for cell in cells])
    if not comparable:
        drawn[printed, 0] = drawn[:, 3] = np.nan
    if not np.isfinite(drawn[:, 1:]).any():
        return False
    drawn[printed, 3], drawn[printed, 0] = drawn[printed, 0], np.nan
    logarithmic = np.nanmin(drawn) > 0 and np.nanmax(drawn) > LOGARITHMIC * np.nanmin(drawn)
    if logarithmic:
        drawn = np.log(drawn)
    low, high = np.nanmin(drawn), np.nanmax(drawn)
    for cell, row in zip(cells, DRAWN * (drawn - low) / (high - low or 1)):
        cell.places = row.round(1).tolist()
    return bool(logarithmic)
