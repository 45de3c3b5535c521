"""Inputs of reports on methods for soft shadows."""

from collections.abc import Iterable

from neural_shadows.evaluation.soft_registry import (
    FORMATS,
    LABELS,
    available,
    in_format,
    is_network,
    is_tuned,
    needs_fields,
    tuned_as,
)
from neural_shadows.frames.uses import SEQUENCES
from neural_shadows.layout import frame_sets, screen_networks
from neural_shadows.layout.layout import Layout


def methods(layout: Layout, table: str) -> list[str]:
    """Methods of a table available on this machine, in order."""
    return [*filter(available, _named(layout, table))]


def left_out(layout: Layout, table: str) -> list[str]:
    """Labels of a table's unavailable methods."""
    return [LABELS[method] for method in _named(layout, table) if not available(method)]


def _named(layout: Layout, table: str) -> list[str]:
    rows = layout.entry("tables", table)["methods"]
    return [row if isinstance(row, str) else row["method"] for row in rows]


def frame_set(layout: Layout, table: str) -> str:
    """Frame set of a table."""
    return layout.entry("tables", table)["frame_set"]


def evaluations(layout: Layout, table: str, ending: str) -> list[str]:
    """Evaluation file of each method of a table."""
    frames = frame_set(layout, table)
    return [
        layout.paths.soft_evaluation(ending, frames, method) for method in methods(layout, table)
    ]


def constants(layout: Layout, table: str) -> list[str]:
    """Files of chosen constants of a table's methods, in order."""
    frames = frame_set(layout, table)
    paths = (path for method in methods(layout, table) for path in chosen(layout, frames, method))
    return list(dict.fromkeys(paths))


def chosen(layout: Layout, frame_set: str, method: str) -> list[str]:
    """File of a method's constants, if it has some."""
    if not is_tuned(method):
        return []
    return [layout.paths.soft_constants(frame_set, tuned_as(method))]


def fields(layout: Layout, frame_set: str, method: str) -> list[str]:
    """File of a method's fields, if needed and available."""
    own = layout.entry("frame_sets", frame_set)["path"] is not None
    return [layout.paths.soft_fields(frame_set)] if needs_fields(method) and not own else []


def timed_fields(layout: Layout, table: str) -> list[str]:
    """Files of fields of all methods of a table."""
    frames = frame_set(layout, table)
    paths = (path for method in methods(layout, table) for path in fields(layout, frames, method))
    return list(dict.fromkeys(paths))


def fitted_parts(layout: Layout, frame_set: str) -> list[str]:
    """Frames with scenes covered by the fields."""
    uses = tests(layout, frame_set), validations(layout, frame_set), sequences(layout, frame_set)
    return [part for parts in uses for part in parts]


def fitted_arrays(layout: Layout, frame_set: str) -> list[str]:
    """Arrays of `fitted_parts`."""
    return frame_sets.arrays(fitted_parts(layout, frame_set))


def tests(layout: Layout, frame_set: str) -> list[str]:
    """Test parts of a frame set."""
    scenes = frame_sets.measured_scenes(layout, frame_set)
    return [part for name in scenes for part in frame_sets.parts(layout, name, frame_set, "test")]


def validations(layout: Layout, frame_set: str) -> list[str]:
    """Validation parts of a frame set."""
    scenes = frame_sets.tuned_scenes(layout, frame_set)
    return [p for name in scenes for p in frame_sets.parts(layout, name, frame_set, "validation")]


def measured_arrays(layout: Layout, frame_set: str) -> list[str]:
    """Arrays of test frames and sequences."""
    return frame_sets.arrays([*tests(layout, frame_set), *sequences(layout, frame_set)])


def tested_arrays(layout: Layout, frame_set: str) -> list[str]:
    """Arrays of test frames."""
    return frame_sets.arrays(tests(layout, frame_set))


def tuned_arrays(layout: Layout, frame_set: str) -> list[str]:
    """Arrays of validation frames."""
    return frame_sets.arrays(validations(layout, frame_set))


def occluders(layout: Layout, frame_set: str, method: str) -> list[str]:
    """Occluders of test frames, for networks on rendered frames only."""
    if not is_network(method) or layout.entry("frame_sets", frame_set)["path"] is not None:
        return []
    return [
        layout.paths.occluders(scene, frame_set, part.rsplit("/", 1)[1].removesuffix(".json"))
        for scene in frame_sets.measured_scenes(layout, frame_set)
        for part in frame_sets.parts(layout, scene, frame_set, "test")
    ]


def all_meshes(layout: Layout, frame_set: str) -> list[str]:
    """Meshes of all inserted objects of a frame set, each once."""
    scenes = frame_sets.measured_scenes(layout, frame_set)
    paths = [mesh for scene in scenes for mesh in frame_sets.meshes(layout, scene)]
    return list(dict.fromkeys(paths))


def sequences(layout: Layout, frame_set: str) -> list[str]:
    """Sequence parts of a frame set, of its first scene."""
    settings = layout.entry("frame_sets", frame_set)
    if settings["path"] is not None:
        return []
    first = settings["scenes"][0]
    return [part for use in SEQUENCES for part in frame_sets.parts(layout, first, frame_set, use)]


def widths(layout: Layout, frame_set: str) -> list[str]:
    """File of penumbra widths; none without targets."""
    engine = layout.entry("frame_sets", frame_set).get("engine")
    has_targets = engine is None or engine["targets"]
    return [layout.paths.penumbra_widths(frame_set)] if has_targets else []


def first_tests(layout: Layout, frame_set: str) -> list[str]:
    """First test part of each scene."""
    scenes = frame_sets.measured_scenes(layout, frame_set)
    return [frame_sets.parts(layout, scene, frame_set, "test")[0] for scene in scenes]


def timed_parts(layout: Layout, table: str) -> list[str]:
    """Parts with timed frames: the first ones of two scenes."""
    return first_tests(layout, frame_set(layout, table))[:2]


def timed_meshes(layout: Layout, table: str) -> list[str]:
    """Meshes of all inserted objects of a table's scenes."""
    return all_meshes(layout, frame_set(layout, table))


def timed_generators(layout: Layout, table: str) -> list[str]:
    """Generators of a table's scenes."""
    return all_generators(layout, frame_set(layout, table))


def all_generators(layout: Layout, frame_set: str) -> list[str]:
    """Generators of a frame set's scenes."""
    return frame_sets.generators(layout, frame_sets.measured_scenes(layout, frame_set))


def labels(layout: Layout, table: str) -> dict[str, str]:
    """Labels of a table's methods."""
    return {method: label(layout, method) for method in methods(layout, table)}


def label(layout: Layout, method: str) -> str:
    """Label of a method."""
    if not is_network(method):
        return LABELS[method]
    by_scene = layout.settings["networks_by_scene"]
    networks = by_scene if method in by_scene else layout.settings["screen_experiments"]
    return networks[method]["label"]


def weights(layout: Layout, method: str) -> list[str]:
    """Weight files of a method; none without networks."""
    file = "weights.safetensors"
    return [layout.paths.screen_network(file, name) for name in experiments(layout, method)]


def experiments(layout: Layout, method: str) -> list[str]:
    """Experiments of a method: one, one per scene, or none."""
    if not is_network(method):
        return []
    by_scene = layout.settings["networks_by_scene"]
    if method in by_scene:
        return by_scene[method]["experiments"]
    return [_of_formats(layout).get(method, (method, "auto"))[0]]


def forms(layout: Layout, methods: Iterable[str]) -> set[str]:
    """Forms of the networks among methods."""
    names = [name for method in methods for name in experiments(layout, method)]
    return screen_networks.forms(layout, names)


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
        for name in layout.settings["screen_experiments"]
        for number_format in FORMATS
    }


def timed_methods(layout: Layout, table: str) -> dict[str, str | None]:
    """Timed experiment of each method: the first of several, or None."""
    return {key: next(iter(experiments(layout, key)), None) for key in methods(layout, table)}


def timed_weights(layout: Layout, table: str) -> list[str]:
    """Weight files of a table's timed networks."""
    return [
        layout.paths.screen_network("weights.safetensors", name)
        for name in timed_methods(layout, table).values()
        if name
    ]


def trainings(layout: Layout, table: str) -> list[str]:
    """training.json files of a table's networks."""
    names = [name for method in methods(layout, table) for name in experiments(layout, method)]
    return [layout.paths.screen_network("training.json", name) for name in names]


def shown_scenes(layout: Layout, table: str) -> list[str]:
    """Scenes of a table's test frames."""
    settings = layout.entry("tables", table)
    match settings.get("over"):  # of a summary
        case "trained":
            return frame_sets.tuned_scenes(layout, settings["frame_set"])
        case "unseen":
            return layout.entry("frame_sets", settings["frame_set"])["unseen"]
    return frame_sets.measured_scenes(layout, settings["frame_set"])


def radii(layout: Layout, table: str) -> list[str]:
    """Radii of a table's frame set as text."""
    settings = layout.entry("frame_sets", frame_set(layout, table))
    unit = {"metres": "m", "scene_sizes": "S"}[settings["radius_unit"]]
    return [f"{radius:.3g} {unit}" for radius in settings["radii"]]


def times(layout: Layout, table: str) -> list[str]:
    """Times of a table; none without a column, or of a user's frames."""
    own = layout.entry("frame_sets", frame_set(layout, table))["path"] is not None
    timed = "time" in layout.entry("tables", table).get("metrics", ["time"])
    return [layout.paths.soft_times(table)] if timed and not own else []
