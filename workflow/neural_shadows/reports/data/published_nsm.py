"""The numbers that Datta et al. 2022 print (config/published_nsm.csv)."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.reports.data.published import by_cell
from neural_shadows.settings.records import Profile

PAPER = "Datta et al. 2022"


def read_published_nsm(path: Path) -> pd.Series:
    """The printed numbers: a Series of values by (table, row, column), in the file's units."""
    return by_cell(pd.read_csv(path, dtype={"table": str, "value": float}))


def printed(
    published: pd.Series, table: str | None, rows: Iterable[str], column: str
) -> np.ndarray:
    """A printed column of some rows, (n,) float64; NaN where none is printed."""
    return np.array([published.get((table, row, column), np.nan) for row in rows], dtype=float)


def printed_size(published: pd.Series) -> tuple[int, int]:
    """Width and height of the paper's frames, in pixels."""
    width, height = (published[("nsm.data", "frame", side)] for side in ("width", "height"))
    return int(width), int(height)


def titled(title: str, table: str | None) -> str:
    """A table's heading with the paper's number of it: `nsm.s2` is table S2."""
    return title if table is None else f"{title} (table {table[4:].upper()} of {PAPER})"


def beside(profile: Profile, published: pd.Series) -> str:
    """A note on what the printed times and sizes are of, and whether ours are of that size."""
    width, height = printed_size(published)
    told = (
        f"Printed: {PAPER}, frames of {width} × {height}, 16-bit floats on an RTX 2080 Ti; another "
        "machine's milliseconds."
    )
    if (profile["width"], profile["height"]) == (width, height):
        return told
    return f"{told} Ours are of frames of another size: differences are of weights alone."
