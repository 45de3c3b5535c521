"""Methods of frames: their weights, constants and labels."""

from collections.abc import Iterable
from pathlib import Path

from neural_shadows.evaluation.registry import (
    FORMATS,
    FRAME_METHODS,
    LABELS,
    UNLEARNED,
    frame_method,
    in_format,
    is_network,
)
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.paths import ALL


def chosen(layout: Layout, frame_set: str, method: str) -> list[str]:
    """File of a method's constants, if it has some."""
    tuned = frame_method(method)
    if not tuned.constants:
        return []
    return [layout.paths.constants(frame_set, tuned.tuned_as or method, ALL)]


def fields(layout: Layout, frame_set: str, method: str) -> list[str]:
    """File of a method's fields, if needed and available."""
    own = layout.frames(frame_set)["path"] is not None
    return [layout.paths.soft_fields(frame_set)] if frame_method(method).fields and not own else []


def has_history(method: str) -> bool:
    """Check for a method that uses the frames before, in a sequence, by constants of their own."""
    return not is_network(method) and bool(frame_method(method).of_history)


def occluders(layout: Layout, frame_set: str, method: str) -> list[str]:
    """Occluders of rendered test frames, for networks, and null predictors beside them.

    The latter on frames alone of which a table is on occluders: they take a minute.
    """
    tables = layout.settings["tables"].values()
    listed = {table["frame_set"] for table in tables if table["kind"] == "screen_solids"}
    asked = is_network(method) or method in UNLEARNED and frame_set in listed
    if not asked or layout.frames(frame_set)["path"] is not None:
        return []
    return [layout.paths.frame_measure("occluders.npy", frame_set)]


def label(layout: Layout, method: str, frame_set: str | None = None) -> str:
    """Label of a method; of a user's base shadows without a filter."""
    if not is_network(method):
        channel = FRAME_METHODS[method].channel if method in FRAME_METHODS else None
        own = frame_set is not None and layout.frames(frame_set)["path"] is not None
        return f"Base: its own {channel}" if own and channel else LABELS[method]
    by_scene = layout.settings["networks_by_scene"]
    networks = by_scene if method in by_scene else layout.settings["experiments"]
    return networks[method]["label"]


def weights(layout: Layout, method: str) -> list[str]:
    """Weight files of a method; none without networks."""
    file = "weights.safetensors"
    return [layout.paths.network(file, name) for name in experiments(layout, method)]


def experiments(layout: Layout, method: str) -> list[str]:
    """Experiments of a method: one, one per scene, or none."""
    if not is_network(method):
        return []
    by_scene = layout.settings["networks_by_scene"]
    if method in by_scene:
        return by_scene[method]["experiments"]
    return [_of_formats(layout).get(method, (method, "auto"))[0]]


def network_modules(layout: Layout, methods: Iterable[str]) -> set[Path]:
    """Modules of the networks among methods."""
    names = [name for method in methods for name in experiments(layout, method)]
    return layout.network_modules(names)


def by_scene(layout: Layout, method: str) -> bool:
    """Check for one network per scene."""
    return method in layout.settings["networks_by_scene"]


def precision(layout: Layout, method: str) -> str:
    """Number format of a method's network."""
    return _of_formats(layout).get(method, (method, "auto"))[1]


def _of_formats(layout: Layout) -> dict[str, tuple[str, str]]:
    """Experiment and number format by method key."""
    return {
        in_format(name, number_format): (name, number_format)
        for name, entry in layout.settings["experiments"].items()
        if "frame_set" in entry
        for number_format in FORMATS
    }
