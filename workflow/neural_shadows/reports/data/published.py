"""Printed numbers of the thesis and of two papers (config/published*.csv)."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import repeat
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.equivalent_maps import equivalent_maps
from neural_shadows.settings.kinds import PACKAGE
from neural_shadows.settings.records import MeshReport, Row

CONFIG = PACKAGE.parents[1] / "config"
# Files of printed numbers, by text.
PRINTED = {
    "thesis": CONFIG / "published.csv",
    "nsm": CONFIG / "published_nsm.csv",
    "kpnsm": CONFIG / "published_kpnsm.csv",
}
OF_ANY_MESH = ("size_kib", "memory_mib")

# What the thesis measures on the scenes of chapter 4: its table, and what its networks are called.
TABLE_OF_SCENE = {"dragon": "4.3", "fence": "4.4", "landscape": "4.5"}
NETWORKS = {
    "network": "Thesis's network, as printed",
    "network_general": "Thesis's network, as printed",
    "network_single_axis": "Thesis's network, single axis, as printed",
}
SIZE = ("4.6", "dragon_256", "size_kib")  # of each of these networks


def read_published(path: Path) -> pd.Series:
    """Read printed numbers: a Series of values by (table, row, column).

    `row` is the pipeline's key of the method. Values are as printed, save two shadow maps of
    table 4.7: their 256 and 64 KiB are 0.25 and 0.0625 MiB, so that the column has one unit.
    """
    return by_cell(read_rows(path))


def read_rows(path: Path) -> pd.DataFrame:
    """Read a row for each printed number, with the row's `label` in the thesis."""
    return pd.read_csv(path, dtype={"table": str, "value": float})


def by_cell(rows: pd.DataFrame) -> pd.Series:
    """Index the rows of `read_rows` by (table, row, column)."""
    return rows.set_index(["table", "row", "column"])["value"]


def printed_table(published: pd.Series, number: str) -> pd.DataFrame:
    """A printed table: a row a method, by key, and a column a value."""
    return published.unstack("column").loc[number]


def printed_networks(published: pd.Series, scene: str) -> pd.DataFrame:
    """Printed values of the thesis's networks on a scene of `TABLE_OF_SCENE`.

    Columns `method` (a label), `lpips`, `psnr` (a mean), `ssim`, `stored_bytes`, and those of
    `equivalent_maps`, of its own shadow maps.
    """
    table = printed_table(published, TABLE_OF_SCENE[scene])[["lpips", "psnr", "ssim"]]
    table = table.assign(**equivalent_maps(table, table.index, "psnr"))
    table = table.assign(method=table.index.map(NETWORKS), stored_bytes=1024 * published[SIZE])
    return table.dropna(subset="method")


def add_printed(
    frame: pd.DataFrame,
    rows: Sequence[Row],
    columns: Sequence[str],
    number: str | None,
    published_csv: Path,
    meshes: Mapping[str, MeshReport],
) -> pd.DataFrame:
    """Add `thesis_<column>` and `<column>_minus_thesis`; NaN without a printed number.

    Beside a mesh that the thesis did not measure stand its sizes alone; `rows` are the frame's.

    Args:
        number: the thesis's number of the table, "4.3"; None for a table of our own.
        meshes: `thesis_mesh` of each scene.
    """
    published = read_published(published_csv)
    for column in columns:
        measured = [column in OF_ANY_MESH or meshes[row["scene"]]["thesis_mesh"] for row in rows]
        values = [published.get((number, row["published"], column), np.nan) for row in rows]
        frame = frame.assign(**{f"thesis_{column}": np.where(measured, values, np.nan)})
    minus = {f"{name}_minus_thesis": frame[name] - frame[f"thesis_{name}"] for name in columns}
    return frame.assign(**minus)


def printed_column(
    published: pd.Series, table: str | None, rows: Iterable[str], columns: str | Iterable[str]
) -> np.ndarray:
    """A printed column of some rows, (n,) float64; NaN without a printed number.

    Args:
        columns: the column's name, or one for each row.
    """
    names = repeat(columns) if isinstance(columns, str) else columns
    keys = ((table, row, column) for row, column in zip(rows, names))
    return np.array([published.get(key, np.nan) for key in keys], dtype=float)


def with_printed(
    table: pd.DataFrame, name: str, printed: Sequence[float], comparable: bool = True
) -> pd.DataFrame:
    """Add `printed_NAME` and `NAME_minus_printed`.

    Args:
        comparable: false if the difference has no meaning, and is NaN.
    """
    table = table.assign(**{f"printed_{name}": printed})
    difference = table[name] - table[f"printed_{name}"]
    return table.assign(**{f"{name}_minus_printed": difference if comparable else np.nan})


def printed_value(
    published: pd.Series, table: str | None, row: str | None, column: str, metric: str
) -> float:
    """A metric in a cell of a table (`kpnsm.1`), in our units; NaN if none is printed."""
    if table is None or row is None:
        return np.nan
    key = (f"T{table.removeprefix('kpnsm.')}", row, column)
    factor = metrics()[metric].factor if metric in metrics() else 1  # the paper's units are ours
    return 1 / factor * published.get(key, np.nan)


def printed_size(published: pd.Series) -> tuple[int, int]:
    """Width and height of the frames of Datta et al. 2022, in pixels."""
    width, height = (published[("nsm.data", "frame", side)] for side in ("width", "height"))
    return int(width), int(height)
