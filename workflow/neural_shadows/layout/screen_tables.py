"""Inputs of tables of trained screen-space networks."""

from collections.abc import Iterable
from typing import Any

from neural_shadows.evaluation.soft_registry import UNLEARNED, is_network
from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import unique


def files(
    layout: Layout, table: str, methods: Iterable[str], evaluated: Iterable[str] = ()
) -> dict[str, Any]:
    """Metrics of methods and null predictors, and trainings of networks.

    Args:
        methods: of the table's frame set. evaluated: keys evaluated in their place, such as networks in
            a number format.
    """
    paths, frame_set = layout.paths, soft_methods.frame_set(layout, table)
    methods = unique(methods)
    measured = [*evaluated] or methods
    measured = unique([*measured, *UNLEARNED]) if measured else []
    return {
        "soft_metrics": [paths.soft_evaluation("csv", frame_set, method) for method in measured],
        "trainings": [
            paths.screen_network("training.json", m) for m in filter(is_network, methods)
        ],
        "widths_json": soft_methods.widths(layout, frame_set) if measured else [],
    }


def sensitivities(layout: Layout, table: str, networks: Iterable[str]) -> list[str]:
    """Sensitivities of networks on a table's frame set."""
    frame_set = soft_methods.frame_set(layout, table)
    return [layout.paths.screen_sensitivity(frame_set, name) for name in unique(networks)]


def frames_json(layout: Layout, table: str) -> str:
    """First part of the test frames of a table."""
    return soft_methods.tests(layout, soft_methods.frame_set(layout, table))[0]


def labels(layout: Layout, methods: Iterable[str]) -> dict[str, str]:
    """Labels of methods, each once."""
    return {method: soft_methods.label(layout, method) for method in unique(methods)}
