"""What tables of trained networks on frames are made of."""

from typing import Any

from neural_shadows.evaluation.soft_method_names import UNLEARNED, in_format, is_network
from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout

KINDS = (
    *("screen_depth", "screen_features", "screen_errors", "screen_solids"),
    *("screen_steps", "screen_temporal"),
)


def methods(layout: Layout, table: str) -> list[str]:
    """The methods of a table in its order, each once."""
    settings = layout.entry("tables", table)
    match settings["kind"]:
        case "screen_steps":
            named = [one["experiment"] for one in settings["steps"].values() if one["experiment"]]
        case "screen_errors" | "screen_solids":
            named = settings["networks"]
        case "screen_temporal":
            named = settings["methods"]
        case _:
            named = settings["columns"].values()
    return list(dict.fromkeys(named))


def files(layout: Layout, table: str) -> dict[str, Any]:
    """Files of a table's methods on its frame set, of what learns nothing, and of the networks."""
    paths, frame_set = layout.paths, soft_methods.frame_set(layout, table)
    named = methods(layout, table)
    networks = [*filter(is_network, named)]
    asked = _in_formats(layout, table) or named
    asked = [*asked, *(null for null in UNLEARNED if asked and null not in asked)]
    return {
        "soft_metrics": [paths.soft_evaluation("csv", frame_set, method) for method in asked],
        "trainings": [paths.screen_network("training.json", name) for name in networks],
        "sensitivities": [paths.screen_sensitivity(frame_set, name) for name in networks],
        "profiles": _profiles(layout, table),
        "frames_json": soft_methods.tests(layout, frame_set)[0],
        "widths_json": soft_methods.widths(layout, frame_set) if asked else [],
    }


def _in_formats(layout: Layout, table: str) -> list[str]:
    """The methods that steps are: networks in number formats; none of another table."""
    steps = layout.entry("tables", table).get("steps", {}).values()
    return [in_format(one["experiment"], one["precision"]) for one in steps if one["experiment"]]


def _profiles(layout: Layout, table: str) -> list[str]:
    steps = layout.entry("tables", table).get("steps", {}).values()
    return [layout.paths.screen_profile(name) for name in {step["network"]: 0 for step in steps}]


def labels(layout: Layout, table: str) -> dict[str, str]:
    """What each method of a table is called."""
    return {method: soft_methods.label(layout, method) for method in methods(layout, table)}
