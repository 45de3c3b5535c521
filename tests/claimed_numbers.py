"""Numbers of tables in our texts, and the CSVs that they are of.

A table names its CSVs in a comment before it: `<!-- numbers: FILE.csv -->`. The numbers of each of its
rows, without the first cell, must be those of one method in these files, whatever their columns; with
`<!-- numbers by column: … -->` those of each column; with `of N: ` before the files, of N methods. Such a comment behind a sentence or
several, in their paragraph or list item, is on the numbers since the last.

A table with `<!-- verdicts: FILE.csv … -->` counts the claims of each text that need a run, by verdict: of a
claim in several files, by that in the last.
"""

import csv
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from itertools import combinations
from pathlib import Path

from neural_shadows.reports.data import verdicts
from neural_shadows.reports.page.claim_cards import SOURCES

MARK = re.compile(r"<!-- numbers( by column)?:(?: of (\d):)? ([^>]+\.csv) -->\n\n?((?:\|.*\n)+)")
SAID = re.compile(r"<!-- numbers:(?: of (\d):)? ([^>]+\.csv) -->")
MEASURED = re.compile(r"\d (?:dB|ms|frames a second)\b")  # is always of a CSV
ITEMS = r"\n\s*\n|\n(?=\s*(?:-|\d+\.) |#|\|)"  # paragraphs, list items and headings begin so
NO_PROSE = re.compile(
    r"<!--(?! numbers:).*?-->|\]\([^)]*\)", re.S
)  # other comments, targets of links
COUNTED = re.compile(r"<!-- verdicts: ([^>]+\.csv) -->\n\n?((?:\|.*\n)+)")
# What a column of such a table counts, by its heading.
COUNTS = {
    "all": verdicts.VERDICTS,
    "supported": (verdicts.SUPPORTED,),
    "contradicted": (verdicts.CONTRADICTED,),
    "not learned, undecided": (verdicts.NOT_LEARNED, verdicts.TOO_SMALL, verdicts.UNDECIDED),
    "not comparable": (verdicts.NOT_COMPARABLE,),
    "vacuous": (verdicts.VACUOUS,),
}
NUMBER = re.compile(r"(?<![\w.])[-−+]?\d[\d,]*(?:\.\d+)?")
# What a column's numbers may be multiplied by: percent, × 10⁻⁴, KiB, MiB, 10⁶.
UNITS = (1, 1e2, 1e4, 1 / 1024, 1 / 1024**2, 1e-6)


def mistakes(text: str, folder: Path) -> list[str]:
    """Lines of marked tables, and marked sentences, whose numbers no method has, one message each."""
    found = []
    for by_column, count, names, table in MARK.findall(text):
        for line in _lines(table, bool(by_column)):
            found += _unknown(line[1:], " | ".join(line), count, names, folder)
    for words, count, names in said(text):
        found += _unknown([words], words, count, names, folder)
    return found


def said(text: str) -> Iterator[tuple[str, str, str]]:
    """Marked prose, the number of its methods and its files."""
    for block in re.split(ITEMS, NO_PROSE.sub("", MARK.sub("\n", text))):
        start = 0
        for mark in SAID.finditer(block):
            if words := " ".join(block[start : mark.start()].split()):
                yield words, mark[1], mark[2]
            start = mark.end()


def unmarked(text: str) -> list[str]:
    """Prose with a measured number and no file behind it."""
    tails = (
        SAID.split(block)[-1] for block in re.split(ITEMS, NO_PROSE.sub("", MARK.sub("\n", text)))
    )
    return [" ".join(tail.split()) for tail in tails if MEASURED.search(tail)]


def _unknown(
    cells: Iterable[str], shown: str, count: str, names: str, folder: Path
) -> Iterator[str]:
    """A message where `count` methods of files have not all numbers of the cells."""
    tokens = [number for cell in cells for number in NUMBER.findall(cell)]
    methods = _methods(folder / name for name in names.split())
    of_each = [{t for t in tokens if _has(method, t)} for method in methods]
    sets = combinations([own for own in of_each if own], int(count or 1))
    if tokens and not any(set().union(*own) >= {*tokens} for own in sets):
        yield f"{names}: no method has all numbers of {shown}"


def miscounts(text: str, folder: Path) -> list[str]:
    """Rows of tables of verdicts that count other claims than the file has, one message each."""
    found = []
    for names, table in COUNTED.findall(text):
        of_names: dict[str, dict[str, str]] = {}
        for name in names.split():
            with (folder / name).open(encoding="utf-8", newline="") as file:
                of_names |= {row["claim"]: row for row in csv.DictReader(file)}
        claims = [row for row in of_names.values() if row["kind"] != "printed"]
        (_, *head), _, *body = _cells(table)
        for source, *cells in body:
            of = [row["verdict"] for row in claims if SOURCES[row["text"]] == source]
            counts = [str(sum(one in COUNTS[column] for one in of)) for column in head]
            if counts != cells:
                found.append(f"{names}: {source}: {counts}, and not {cells}")
    return found


def _lines(table: str, by_column: bool) -> Iterator[list[str]]:
    """Cells of each row or column, the heading first."""
    head, _, *body = _cells(table)
    columns = [list(cells) for cells in zip(head, *body)]
    yield from columns[1:] if by_column else body


def _cells(table: str) -> list[list[str]]:
    return [[cell.strip() for cell in row.strip()[1:-1].split("|")] for row in table.splitlines()]


def _methods(paths: Iterable[Path]) -> list[tuple[set[str], list[float]]]:
    """Of each method of CSVs the words of its labels, and all numbers of every row that it has."""
    methods: dict[str, tuple[set[str], list[float]]] = defaultdict(lambda: (set(), []))
    for path in paths:
        for row in csv.DictReader(path.read_text(encoding="utf-8").splitlines()):
            labels = [row[key] for key in ("method", "label", "mesh") if key in row]
            labels = labels or [next(iter(row.values()))]  # a table of steps has no methods
            words, numbers = methods[labels[0]]
            words.update(word.strip(",²³") for label in labels for word in label.split())
            numbers += [float(cell) for cell in row.values() if _is_number(cell)]
    return [*methods.values()]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _has(method: tuple[set[str], list[float]], token: str) -> bool:
    words, numbers = method
    text = token.replace(",", "").replace("−", "-").rstrip(".")
    half = 0.5 * 10.0 ** -len(text.partition(".")[2]) * 1.001
    stated = float(text)
    return token.rstrip(",") in words or any(
        abs(number * unit - stated) <= half for number in numbers for unit in UNITS
    )
