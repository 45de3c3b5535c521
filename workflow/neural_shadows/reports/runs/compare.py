"""Comparison of two runs, number by number.

    PYTHONPATH=workflow python -m neural_shadows.reports.runs.compare OLD NEW [TABLE ...]

Reads the CSVs of folder OLD, all or those of the named tables, and those of the same names in NEW.
Ends with status 1 where something differs, is missing or cannot be compared.
"""

import csv
import math
import re
import sys
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.data.digits import short

SAME = "same"
WITHIN = "within its interval"
DIFFERS = "differs"
NOT_COMPARED = "not compared"
VERDICTS = (SAME, WITHIN, DIFFERS, NOT_COMPARED)

# Processors round differently. Of soft_methods.csv by one with AVX2 and one with AVX-512 98 % of the
# numbers agree to 1e-3; the others are errors below 1e-4, and of Open Image Denoise. Of sun_hours.csv
# the small differences of fields from rays differ by up to 2.4e-3.
ROUNDING = 3e-3
LARGEST = 10  # differences that are shown
FEW = 5  # names that are shown

# Columns of times and machines, by a word of their name or their whole name.
_MEASURED = re.compile(
    r"(^|_)(ms|s|seconds|minutes|time|runtime|rate|per_second|rss|ceiling|peer|device|run|repeats)(_|$)"
    r"|^(ratio_with_build|share|product_share)$"
)
# Repetitions of other numbers: differences from printed ones, and a claim's evidence.
_REPEATED = re.compile(r"_minus_|^(reason|evidence|number)$")
_ENDS = ("_low", "_high")  # of the interval of the column named before them

Row = dict[str, str]


@dataclass(frozen=True)
class Difference:
    """A number that differs, and by which share of the larger; infinite of a text."""

    table: str
    place: str
    old: str
    new: str
    share: float

    def __str__(self) -> str:
        share = "" if math.isinf(self.share) else f" ({short(100 * self.share)} %)"
        return f"{self.table}: {self.place}: {self.old or 'empty'} → {self.new or 'empty'}{share}"


@dataclass
class Comparison:
    """Numbers by verdict, those that differ, and what cannot be compared.

    `only`: names of rows and columns in one table alone, by `"OLD has no columns"`.
    """

    counts: Counter[str] = field(default_factory=Counter)
    differences: list[Difference] = field(default_factory=list)
    only: dict[str, list[str]] = field(default_factory=dict)


def compare_tables(old_csv: Path, new_csv: Path) -> Comparison:
    """Compare two tables.

    Rows are matched by the fewest columns from the left that name each row once. A number with an
    interval is `WITHIN` if the new number lies in the old interval.

    Raises:
        InputError: a file is missing, or the tables are of different scales.
    """
    old, new = _read(old_csv), _read(new_csv)
    _check_scales(new_csv, old, new)
    ours, theirs = _by_name(old, new)
    columns = [[*rows[0]] if rows else [] for rows in (old, new)]
    result = Comparison()
    for what, here, there in (
        ("columns", *columns),
        ("rows", [*map(" ".join, ours)], [*map(" ".join, theirs)]),
    ):
        result.only[f"{new_csv} has no {what}"] = [name for name in here if name not in there]
        result.only[f"{old_csv} has no {what}"] = [name for name in there if name not in here]
    shared = [name for name in columns[0] if name in columns[1] and not _is_end(name, columns[0])]
    for name in ours.keys() & theirs.keys():
        for column in shared:
            _compare_number(ours[name], theirs[name], column, old_csv.name, name, result)
    return result


def _read(path: Path) -> list[Row]:
    try:
        with path.open(encoding="utf-8", newline="") as file:
            return [*csv.DictReader(file)]
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}). Make it first") from error


def _check_scales(new_csv: Path, old: Sequence[Row], new: Sequence[Row]) -> None:
    before, after = (
        " and ".join(sorted({row.get("scale") or "none" for row in rows})) for rows in (old, new)
    )
    if before != after:
        raise InputError(
            f"{new_csv}: scale: {after}, and {before} in the old run. Compare runs of one scale"
        )


def _by_name(*tables: Sequence[Row]) -> list[dict[tuple[str, ...], Row]]:
    """Rows by the columns that name them, the same in all tables; else by number."""
    columns = [*tables[0][0]] if tables[0] else []
    for count in range(1, len(columns) + 1):
        named = [{tuple(r.get(c, "") for c in columns[:count]): r for r in rows} for rows in tables]
        if all(len(one) == len(rows) for one, rows in zip(named, tables)):
            return named
    return [{(str(number),): row for number, row in enumerate(rows)} for rows in tables]


def _is_end(column: str, columns: Sequence[str]) -> bool:
    """Check for an end of another column's interval."""
    return column.endswith(_ENDS) and column.rpartition("_")[0] in columns


def _compare_number(
    old: Row, new: Row, column: str, table: str, row: Sequence[str], result: Comparison
) -> None:
    """Count a number with its interval, and keep it if it differs."""
    pair = old[column], new[column]
    if not any(pair):
        return
    if _is_measured(column, old) or _REPEATED.search(column):
        verdict = NOT_COMPARED
    elif all(_same(old.get(column + end, ""), new.get(column + end, "")) for end in ("", *_ENDS)):
        verdict = SAME
    elif _within(new[column], *(old.get(column + end, "") for end in _ENDS)):
        verdict = WITHIN
    else:
        verdict = DIFFERS
        place = f"{' '.join(row)}, {column}"
        result.differences.append(Difference(table, place, *pair, _share(*pair)))
    result.counts[verdict] += 1


def _is_measured(column: str, row: Row) -> bool:
    """Whether a column has times or machines; a `ratio` beside times is one of them."""
    return bool(_MEASURED.search(column)) or (column == "ratio" and any(map(_MEASURED.search, row)))


def _same(old: str, new: str) -> bool:
    """Check for equal texts, or numbers equal but for rounding."""
    return old == new or _share(old, new) <= ROUNDING


def _within(*texts: str) -> bool:
    """Check for a number between two ends."""
    numbers = [*map(_numbers, texts)]
    if any(len(one) != 1 for one in numbers):
        return False
    (value,), (low,), (high,) = numbers
    return low <= value <= high


def _share(old: str, new: str) -> float:
    """Largest share by which numbers of cells differ; infinite of other texts."""
    a, b = _numbers(old), _numbers(new)
    if not a or len(a) != len(b):
        return math.inf
    return max(abs(x - y) / (max(abs(x), abs(y)) or 1) for x, y in zip(a, b))


def _numbers(text: str) -> list[float]:
    """Numbers of a cell, several by seed; none of another text."""
    try:
        return [*map(float, text.split())]
    except ValueError:
        return []


def compare_runs(old: Path, new: Path, tables: Sequence[str] = ()) -> tuple[list[str], bool]:
    """Compare the tables of two runs' folders.

    Args:
        tables: names; none for all of the old run.

    Returns: the lines of a report, and true if nothing differs.

    Raises:
        InputError: the old folder has no tables.
    """
    paths = [old / f"{name}.csv" for name in tables] or sorted(old.glob("*.csv"))
    if not paths:
        raise InputError(f"{old}: has no tables (*.csv). Name a folder of a run's reports")
    lines, faults, total = [*_described(old, new)], [], Comparison()
    for path in paths:
        try:
            result = compare_tables(path, new / path.name)
        except InputError as error:
            faults.append(str(error))
            continue
        lines.append(f"{path.name}: {_counted(result)}")
        faults += [f"{where} {_few(names)}" for where, names in result.only.items() if names]
        total.counts += result.counts
        total.differences += result.differences
    lines += [f"in all: {_counted(total)}"] * (len(paths) > 1) + faults
    largest = sorted(total.differences, key=lambda one: -one.share)[:LARGEST]
    if largest:
        lines.append("Largest differences:")
    return [*lines, *map(str, largest)], not (largest or faults)


def _described(*folders: Path) -> Iterator[str]:
    """Commit and machine of each run with a manifest."""
    for folder in folders:
        if (folder / "manifest.json").exists():
            manifest = read_json(folder / "manifest.json")
            yield f"{folder}: commit {manifest['commit']}, {manifest['machine']['cpu']}"


def _counted(result: Comparison) -> str:
    counts = result.counts
    return ", ".join(f"{one} {counts[one]:,}" for one in VERDICTS if counts[one]) or "no numbers"


def _few(names: Sequence[str]) -> str:
    rest = f" and {len(names) - FEW} more" if len(names) > FEW else ""
    return ", ".join(names[:FEW]) + rest


def main() -> None:
    """Compare the runs of the command line."""
    parser = ArgumentParser(description="Compare two runs, number by number.")
    parser.add_argument("old", type=Path, help="folder of a run's reports")
    parser.add_argument("new", type=Path, help="that of the run to compare with it")
    parser.add_argument("tables", nargs="*", help="names of tables, by default all of the old run")
    arguments = parser.parse_args()
    try:
        lines, equal = compare_runs(arguments.old, arguments.new, arguments.tables)
    except InputError as error:
        sys.exit(str(error))
    print("\n".join(lines))
    sys.exit(not equal)


if __name__ == "__main__":
    main()
