"""What files a report is given, by what their paths say."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.memory import stored_bytes
from neural_shadows.evaluation.method_names import unbiased
from neural_shadows.files.whole_files import read_json

Record = Mapping[str, Any]


def by_folder(paths: Iterable[Path]) -> dict[str, list[Path]]:
    """Paths by the name of their folder: a scene, an experiment or a table."""
    found: dict[str, list[Path]] = {}
    for path in paths:
        found.setdefault(path.parent.name, []).append(path)
    return found


def read_meshes(paths: Iterable[Path]) -> dict[str, dict[str, Any]]:
    """What `prepare_mesh` wrote, by scene."""
    return {path.parent.name: read_json(path) for path in paths}


def read_biases(
    rows: Sequence[Record], paths: Iterable[Path]
) -> dict[tuple[str, str], dict[str, Any]]:
    """The depth bias of each row that has one, by scene and method.

    Returns: `depth_bias` (sphere radii), `push` (cells), and `at_end`, whether a found one is the
        first or the last that was tried.
    """
    found = {(path.parent.name, path.stem): read_json(path) for path in paths}
    return {
        (row["scene"], row["method"]): found[row["scene"], unbiased(row["method"])]
        if row["bias"] == "held_out"
        else {"depth_bias": row["bias"], "push": 0.0, "at_end": False}
        for row in rows
        if row["bias"] is not None
    }


def read_sizes(rows: Sequence[Record], weights: Iterable[Path]) -> dict[str, float]:
    """Bytes that each method of the rows stores; NaN for one that stores nothing of its own."""
    files = {path.parent.name: path for path in weights}
    sizes = {
        row["method"]: stored_bytes(files.get(row["experiment"], unbiased(row["method"])))
        for row in rows
    }
    return {method: np.nan if size is None else size for method, size in sizes.items()}


def read_seconds(benchmarks: Iterable[Path]) -> float:
    """Seconds of some jobs, one after another, from their benchmarks; NaN if one is missing."""
    try:
        return sum(pd.read_csv(path, sep="\t")["s"].sum() for path in benchmarks)
    except FileNotFoundError:  # a result that was copied here, or made before a benchmark was kept
        return np.nan
