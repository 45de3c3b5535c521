"""What files a report is given, by what their paths say."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from neural_shadows.evaluation.memory import network_bytes, shadow_map_bytes
from neural_shadows.evaluation.method_names import RAY_TRACED
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
    """The depth bias of each network among the rows, by method."""
    found = {path.stem: read_json(path)["depth_bias"] for path in paths}
    return {
        row["method"]: found[row["experiment"]] if row["bias"] == "held_out" else row["bias"]
        for row in rows
        if row["experiment"]
    }


def read_sizes(rows: Sequence[Mapping[str, Any]], weights: Iterable[Path]) -> dict[str, int]:
    """Bytes of each network and shadow map among the rows, by method."""
    stored = {path.parent.name: network_bytes(path) for path in weights}
    return {
        method: stored[experiment] if experiment else shadow_map_bytes(method)
        for method, experiment in ((row["method"], row["experiment"]) for row in rows)
        if method != RAY_TRACED
    }
