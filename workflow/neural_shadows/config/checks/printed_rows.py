"""Checks of the printed rows that tables name."""

import functools
from collections.abc import Iterator

from neural_shadows.reports.data.published import PRINTED, read_published
from neural_shadows.reports.tables import screen_networks, soft_summary
from neural_shadows.sections.any_report import AnyTable
from neural_shadows.sections.rows import RowsTable
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among

_read = functools.cache(read_published)


def check(config: Sections) -> None:
    """Check that rows and columns that tables name are printed.

    Raises:
        ValueError: one is not, or the table has no printed numbers.
    """
    for name, table in config.tables.items():
        for row, column in _named(config, table):
            _check_cell(f"tables.{name}", table.published, row, column)


def _named(config: Sections, table: AnyTable) -> Iterator[tuple[str, str | None]]:
    """Printed rows, and of some a column, that a table's own rows name."""
    rows = []
    if isinstance(table, RowsTable):
        rows = [row for of_scene in table.named_rows(config).values() for row in of_scene]
    elif isinstance(table, soft_summary.Settings):
        rows = table.methods
    elif isinstance(table, screen_networks.Settings):
        rows = table.networks
    for row in rows:
        if row.published:
            yield row.published, getattr(row, "column", None)


def _check_cell(key: str, number: str | None, row: str, column: str | None) -> None:
    if number is None:
        raise ValueError(
            f"{key}: has rows with `published`: {row!r}, and none itself. Set both or none"
        )
    text, _, last = number.rpartition(".")
    printed = _read(PRINTED.get(text, PRINTED["thesis"]))
    printed = printed.loc[f"T{last}" if text == "kpnsm" else number]
    check_among(f"{key}: published", row, printed.index.unique("row"))
    if column:
        check_among(f"{key}: published: {row}: column", column, printed.loc[row].index)
