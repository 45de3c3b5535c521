"""A table's Markdown twin as plain data for the page: the thesis's numbers in our cells, and dots."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from markdown_it import MarkdownIt
from markupsafe import Markup

from neural_shadows.evaluation.method_names import NULL
from neural_shadows.reports.method_look import LOOKS, Look
from neural_shadows.reports.page_blocks import Block, csv_file
from neural_shadows.reports.published import NETWORKS

DIGITS = r"([+-]?\d[\d,]*(?:\.\d+)?)"
NUMBER = re.compile(rf"{DIGITS}(?: \[{DIGITS}, {DIGITS}\])?")
MARK = re.compile(r" \(\*\*[^*]+\*\*\)$")  # behind a method's name
LOGARITHMIC = 20  # times the smallest: values so far apart are drawn so
DRAWN = 82  # width of a cell's drawing, px
INCOMPARABLE = "LPIPS"  # with the thesis's, whose network is not known (`describe_lpips`)
UNRIVALLED = (*NETWORKS.values(), *NULL.values())  # cannot be a column's best
PARTED = ("scene", "light")  # first columns: a table is in parts by them
ORIGIN = "<!--"  # what the last line begins with, of what the table was written by
MARKDOWN = MarkdownIt("commonmark", {"html": False}).enable("table")


@dataclass
class Cell:
    """What stands in a cell of ours, and the thesis's number for it.

    `places` are those of the value, the ends of its interval and the thesis's number in the cell's
    drawing, px from the left, NaN of what is not there; None in a column that has no drawings.
    """

    text: str
    theirs: str = ""
    best: bool = False
    places: Sequence[float] | None = None

    @property
    def numbers(self) -> list[float]:
        """The value, the ends of its interval, and the thesis's number; NaN of what is not there."""
        return [*_numbers(self.text), _numbers(self.theirs)[0]]

    @property
    def html(self) -> Markup:
        """The text without the interval."""
        return inline(self.text.removesuffix(self.interval))

    @property
    def interval(self) -> str:
        """` [low, high]`, or empty."""
        return self.text[self.text.index(" [") :] if np.isfinite(self.numbers[1]) else ""


@dataclass(frozen=True)
class Part:
    """A table of one scene or light: its headings, and rows of which the first cell is a method.

    `looks` are the methods' where they are known; `scene` is empty in a table that has neither;
    `logarithmic`: of the headings those whose columns are drawn so.
    """

    scene: str
    heads: list[str]
    rows: list[tuple[Cell, ...]]
    looks: list[Look | None]
    logarithmic: list[str]


def table_block(path: Path, looks: Mapping[str, Look]) -> Block:
    """A table, in a part for each scene or light; `looks` of methods by label."""
    tokens = MARKDOWN.parse(path.read_text(encoding="utf-8"))
    title, kinds = tokens[1].content, [token.type for token in tokens]
    start, end = kinds.index("table_open"), kinds.index("table_close") + 1
    texts = [token.content for token in tokens[start:end] if token.type == "inline"]
    after = [token.content for token in tokens[end:] if token.type == "inline"]
    count = kinds.count("th_open")
    heads, *rows = (texts[i : i + count] for i in range(0, len(texts), count))
    return Block(
        "table",
        path.stem,
        title,
        parts=[_part(scene, *found, looks) for scene, found in _by_scene(heads, rows).items()],
        notes=tuple(inline(text) for text in after if not text.startswith(ORIGIN)),
        files=csv_file(path.with_suffix(".csv")),
    )


def inline(text: str) -> Markup:
    """A line of Markdown as HTML."""
    return Markup(MARKDOWN.renderInline(text))


def _by_scene(
    heads: list[str], rows: list[list[str]]
) -> dict[str, tuple[list[str], list[list[str]]]]:
    """Headings and rows by scene or light, without its column; one may be named in its first row alone."""
    if heads[0] not in PARTED:
        return {"": (heads, rows)}
    found: dict[str, tuple[list[str], list[list[str]]]] = {}
    for scene, *cells in rows:
        found.setdefault(scene or [*found][-1], (heads[1:], []))[1].append(cells)
    return found


def _part(
    scene: str, heads: Sequence[str], rows: Sequence[Sequence[str]], looks: Mapping[str, Look]
) -> Part:
    """A column of the thesis's goes into that of ours on its left; an empty one is left out."""
    columns: list[tuple[str, list[Cell]]] = []
    for head, texts in zip(heads, zip(*rows)):
        if head.startswith("thesis") and head.removeprefix("thesis").strip() in columns[-1][0]:
            for cell, text in zip(columns[-1][1], texts):
                cell.theirs = text
        elif any(texts):
            columns.append((head, [*map(Cell, texts)]))
    names = [MARK.sub("", cell.text) for cell in columns[0][1]]
    printed = [name in NETWORKS.values() for name in names]
    logarithmic = []
    for head, cells in columns[1:]:
        rivals = [cell for name, cell in zip(names, cells) if name not in UNRIVALLED]
        _mark_best(head, rivals)
        if _place(cells, printed, not head.startswith(INCOMPARABLE)):
            logarithmic.append(head)
    known = looks | dict.fromkeys(NETWORKS.values(), LOOKS["frequency"])
    heads, cells = zip(*columns)
    looked_up = [known.get(name) for name in names]
    return Part(scene, [*heads], [*zip(*cells)], looked_up, logarithmic)


def _mark_best(head: str, cells: Sequence[Cell]) -> None:
    values = np.array([cell.numbers[0] for cell in cells]) * {"↑": 1, "↓": -1}.get(
        head[-1:], np.nan
    )
    if np.isfinite(values).sum() > 1:
        for cell, value in zip(cells, values):
            cell.best = bool(value == np.nanmax(values))


def _place(cells: Sequence[Cell], printed: Sequence[bool], comparable: bool) -> bool:
    """Where the numbers of a column are drawn, if one has an interval or a number of the thesis's.

    Args:
        printed: the rows of the thesis's own values, which are drawn as its numbers are.
        comparable: whether its numbers can stand on the scale of ours.

    Returns: whether the scale is logarithmic.
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


def _numbers(text: str) -> list[float]:
    """A value and the ends of its interval in a cell of Markdown."""
    found = NUMBER.fullmatch(text)
    parts = found.groups() if found else (None,) * 3
    return [np.nan if part is None else float(part.replace(",", "")) for part in parts]
