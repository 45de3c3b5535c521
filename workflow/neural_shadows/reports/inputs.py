"""What files a report is given, by what their paths say."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import read_json


def by_folder(paths: Iterable[Path]) -> dict[str, list[Path]]:
    """Paths by the name of their folder: a scene, an experiment or a table."""
    found: dict[str, list[Path]] = {}
    for path in paths:
        found.setdefault(path.parent.name, []).append(path)
    return found


def read_meshes(paths: Iterable[Path]) -> dict[str, dict[str, Any]]:
    """What `prepare_mesh` wrote, by scene."""
    return {path.parent.name: read_json(path) for path in paths}


def read_biases(rows: Sequence[Mapping[str, Any]], paths: Iterable[Path]) -> dict[str, float]:
    """The depth bias of each network among the rows, by method.

    Args:
        rows: `method`, `experiment`, and `bias`, a number or `held_out`, of each.
        paths: what `find_depth_bias` wrote, a file for each experiment.
    """
    found = {path.stem: read_json(path)["depth_bias"] for path in paths}
    return {
        row["method"]: found[row["experiment"]] if row["bias"] == "held_out" else row["bias"]
        for row in rows
        if row["experiment"] is not None
    }
