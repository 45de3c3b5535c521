"""Metrics of methods for soft shadows: a row for each frame, radius and metric."""

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from neural_shadows.files.whole_files import whole_file

if TYPE_CHECKING:
    import pandas as pd

# `part` is the frame set's, `radius` counts its radii, `frame` the part's frames; a sequence has
# one value for all of its frames.
COLUMNS = dict(
    scene="str", part="str", frame="int64", radius="int64", metric="str", value="float64"
)


def write_soft_metrics(metrics_csv: Path, rows: Iterable[Mapping[str, Any]]) -> None:
    """Write rows with the keys of `COLUMNS`."""
    with whole_file(metrics_csv) as part, part.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(COLUMNS), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_soft_metrics(paths: Iterable[Path]) -> "pd.DataFrame":
    """Join files of `write_soft_metrics`, with names as `method`."""
    import pandas as pd

    tables = (
        pd.read_csv(path, dtype=COLUMNS, usecols=list(COLUMNS)).assign(method=path.stem)
        for path in paths
    )
    return pd.concat(tables, ignore_index=True)
