"""Metrics of methods for soft shadows: a row for each frame, radius and metric."""

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from neural_shadows.errors import InputError
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
    """Read and join files of `write_soft_metrics`: its columns, and `method`, a file's name.

    Raises:
        InputError: a file cannot be read, or is not of such metrics.
    """
    import pandas as pd

    found = []
    for path in paths:
        try:
            one = pd.read_csv(path, dtype=COLUMNS, usecols=list(COLUMNS))
        except (OSError, ValueError) as error:
            raise InputError(f"{path}: damaged ({error}); delete it and run again") from error
        found.append(one.assign(method=path.stem))
    return pd.concat(found, ignore_index=True)
