"""Metrics on disk: a row by frame, radius, method, metric."""

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file

if TYPE_CHECKING:
    import pandas as pd

# `part` is the frame set's, or the view set; `frame` counts its frames, or views; a sequence has one
# value for all of its frames. `radius` counts the light's radii; a sun has one.
COLUMNS = {
    **{"scene": "str", "part": "str", "frame": "int64", "radius": "int64"},
    **{"method": "str", "metric": "str", "value": "float64"},
}


def write_metrics(metrics_csv: Path, rows: Iterable[Mapping[str, Any]]) -> None:
    """Write rows with the keys of `COLUMNS`."""
    with whole_file(metrics_csv) as part, part.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(COLUMNS), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_metrics(paths: Iterable[Path]) -> "pd.DataFrame":
    """Read and join files of `write_metrics`.

    Raises:
        InputError: a file cannot be read, or is not of metrics.
    """
    import pandas as pd  # takes a third of a second, which writers save

    tables = []
    for path in paths:
        try:
            tables.append(pd.read_csv(path, dtype=COLUMNS, usecols=list(COLUMNS)))
        except (OSError, ValueError) as error:
            raise InputError(f"{path}: damaged ({error}). Delete it and run again.") from error
    return pd.concat(tables, ignore_index=True)


def read_view_metrics(paths: Iterable[Path]) -> "pd.DataFrame":
    """Read metrics of views: `view`, `view_set`, `method`, `metric`, `value`.

    Raises:
        InputError: a file cannot be read, or is not of metrics.
    """
    metrics = read_metrics(paths).rename(columns={"frame": "view", "part": "view_set"})
    return metrics[["view", "view_set", "method", "metric", "value"]]
