"""Input files of reports, by the names in their paths."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.memory import stored_bytes
from neural_shadows.evaluation.registry import unbiased
from neural_shadows.files.whole_files import read_json
from neural_shadows.settings.records import DepthBias, Row, TunedRadius


def by_folder(paths: Iterable[Path]) -> dict[str, list[Path]]:
    """Paths by the name of their folder: a scene (also of SCENE.BATCH), an experiment or a table."""
    folders: dict[str, list[Path]] = {}
    for path in paths:
        folders.setdefault(path.parent.name.partition(".")[0], []).append(path)
    return folders


def read_by_folder(paths: Iterable[Path]) -> dict[str, Any]:
    """Read JSON files, one a folder, by the folder's name."""
    return {path.parent.name: read_json(path) for path in paths}


def read_biases(rows: Sequence[Row], paths: Iterable[Path]) -> dict[tuple[str, str], DepthBias]:
    """Read the depth biases of rows by scene and method.

    Returns: `depth_bias` (sphere radii), `push` (cells), and `at_end`, true if a chosen bias is
        the first or last one tried.
    """
    tuned = {(path.parent.name, path.stem): read_json(path)["radii"][0] for path in paths}
    return {
        (row["scene"], row["method"]): _bias(tuned[row["scene"], unbiased(row["method"])])
        if row["bias"] == "held_out"
        else {"depth_bias": row["bias"], "push": 0.0, "at_end": False}
        for row in rows
        if row["bias"] is not None
    }


def _bias(tuned: TunedRadius) -> DepthBias:
    return {"push": 0.0, **tuned["constants"], "at_end": bool(tuned["at_end"])}


def read_sizes(rows: Sequence[Row], weights: Iterable[Path]) -> dict[str, float]:
    """Stored bytes of each method of the rows; NaN without own storage."""
    files = {path.parent.name: path for path in weights}
    sizes = {
        row["method"]: stored_bytes(files.get(row["experiment"], unbiased(row["method"])))
        for row in rows
    }
    return {method: np.nan if size is None else size for method, size in sizes.items()}


def read_seconds(benchmarks: Iterable[Path]) -> float:
    """Sum the seconds of benchmarks; NaN if one is missing."""
    try:
        return sum(pd.read_csv(path, sep="\t")["s"].sum() for path in benchmarks)
    except FileNotFoundError:  # copied results have none
        return np.nan
