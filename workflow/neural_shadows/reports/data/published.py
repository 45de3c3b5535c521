"""The numbers that the thesis prints in its tables 4.1 to 4.7 (config/published.csv)."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.reports.data.equivalent_maps import equivalent_maps
from neural_shadows.settings.records import MeshReport, Row

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
    """Read the printed numbers: a Series of values by (table, row, column).

    `row` is the pipeline's key of the method. Values are as printed, save two shadow maps of
    table 4.7: their 256 and 64 KiB are 0.25 and 0.0625 MiB, so that the column has one unit.
    """
    return by_cell(read_rows(path))


def read_rows(path: Path) -> pd.DataFrame:
    """The file as it is: a row a printed number, with the `label` that the thesis gives its row."""
    return pd.read_csv(path, dtype={"table": str, "value": float})


def by_cell(rows: pd.DataFrame) -> pd.Series:
    """`read_rows` as `read_published` gives it."""
    return rows.set_index(["table", "row", "column"])["value"]


def printed_table(published: pd.Series, number: str) -> pd.DataFrame:
    """A table as the thesis prints it: a row a method, by key, and a column a value."""
    return published.unstack("column").loc[number]


def printed_networks(published: pd.Series, scene: str) -> pd.DataFrame:
    """The thesis's networks on a scene of `TABLE_OF_SCENE`, as printed.

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
    """The frame with `thesis_<column>` and `<column>_minus_thesis`; NaN where none is printed.

    Beside a mesh that the thesis did not measure stand its sizes alone; `rows` are the frame's.

    Args:
        number: the thesis's number of the table, "4.3"; None for one that is not in it.
        meshes: `thesis_mesh` of each scene.
    """
    published = read_published(published_csv)
    for column in columns:
        known = [column in OF_ANY_MESH or meshes[row["scene"]]["thesis_mesh"] for row in rows]
        values = [published.get((number, row["published"], column), np.nan) for row in rows]
        frame = frame.assign(**{f"thesis_{column}": np.where(known, values, np.nan)})
    minus = {f"{name}_minus_thesis": frame[name] - frame[f"thesis_{name}"] for name in columns}
    return frame.assign(**minus)
