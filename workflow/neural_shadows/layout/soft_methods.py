"""What tables and figures of methods for soft shadows are made of."""

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
    """The methods of a table, in its order, that this machine has."""
    return [*filter(available, _named(layout, table))]


def left_out(layout: Layout, table: str) -> list[str]:
    """The labels of the others."""
    return [LABELS[method] for method in _named(layout, table) if not available(method)]


def _named(layout: Layout, table: str) -> list[str]:
    rows = layout.entry("tables", table)["methods"]
    return [row if isinstance(row, str) else row["method"] for row in rows]


def frame_set(layout: Layout, table: str) -> str:
    """The frame set of a table."""
    return layout.entry("tables", table)["frame_set"]


def evaluations(layout: Layout, table: str, ending: str) -> list[str]:
    """A file of each method of a table."""
    one = frame_set(layout, table)
    return [layout.paths.soft_evaluation(ending, one, method) for method in methods(layout, table)]


def constants(layout: Layout, table: str) -> list[str]:
    """What was chosen for the methods of a table that have constants, in its order."""
    one = frame_set(layout, table)
    found = (path for method in methods(layout, table) for path in chosen(layout, one, method))
    return list(dict.fromkeys(found))


def chosen(layout: Layout, frame_set: str, method: str) -> list[str]:
    """The file of a method's constants; none of one without."""
    if not is_tuned(method):
        return []
    return [layout.paths.soft_constants(frame_set, tuned_as(method))]


def fields(layout: Layout, frame_set: str, method: str) -> list[str]:
    """The file of the fields of a method that needs some; none of another, or without a scene."""
    own = layout.entry("frame_sets", frame_set)["path"] is not None
    return [layout.paths.soft_fields(frame_set)] if needs_fields(method) and not own else []


def timed_fields(layout: Layout, table: str) -> list[str]:
    """The same of all methods of a table."""
    one = frame_set(layout, table)
    found = (path for method in methods(layout, table) for path in fields(layout, one, method))
    return list(dict.fromkeys(found))


def fitted_parts(layout: Layout, frame_set: str) -> list[str]:
    """The frames in whose scenes methods may ask fields."""
    asked = tests(layout, frame_set), validations(layout, frame_set), sequences(layout, frame_set)
    return [part for parts in asked for part in parts]


def fitted_arrays(layout: Layout, frame_set: str) -> list[str]:
    """Their arrays."""
    return frame_sets.arrays(fitted_parts(layout, frame_set))


def tests(layout: Layout, frame_set: str) -> list[str]:
    """All test frames of a frame set."""
    scenes = frame_sets.measured_scenes(layout, frame_set)
    return [part for one in scenes for part in frame_sets.parts(layout, one, frame_set, "test")]


def validations(layout: Layout, frame_set: str) -> list[str]:
    """All validation frames of a frame set."""
    scenes = frame_sets.tuned_scenes(layout, frame_set)
    return [p for one in scenes for p in frame_sets.parts(layout, one, frame_set, "validation")]


def measured_arrays(layout: Layout, frame_set: str) -> list[str]:
    """The arrays of test frames and sequences, which lie beside their JSON."""
    return frame_sets.arrays([*tests(layout, frame_set), *sequences(layout, frame_set)])


def tested_arrays(layout: Layout, frame_set: str) -> list[str]:
    """The arrays of test frames."""
    return frame_sets.arrays(tests(layout, frame_set))


def tuned_arrays(layout: Layout, frame_set: str) -> list[str]:
    """The arrays of validation frames."""
    return frame_sets.arrays(validations(layout, frame_set))


def occluders(layout: Layout, frame_set: str, method: str) -> list[str]:
    """What blocks the light in the test frames, which networks' errors are told by; none of another
    method, or of frames of a user's own, where there is no scene to ask.
    """
    if not is_network(method) or layout.entry("frame_sets", frame_set)["path"] is not None:
        return []
    return [
        layout.paths.occluders(scene, frame_set, part.rsplit("/", 1)[1].removesuffix(".json"))
        for scene in frame_sets.measured_scenes(layout, frame_set)
        for part in frame_sets.parts(layout, scene, frame_set, "test")
    ]


def all_meshes(layout: Layout, frame_set: str) -> list[str]:
    """The meshes of the objects that stand in a frame set's scenes, each once."""
    scenes = frame_sets.measured_scenes(layout, frame_set)
    found = [mesh for scene in scenes for mesh in frame_sets.meshes(layout, scene)]
    return list(dict.fromkeys(found))


def sequences(layout: Layout, frame_set: str) -> list[str]:
    """The sequences of a frame set: its first scene has them."""
    settings = layout.entry("frame_sets", frame_set)
    if settings["path"] is not None:
        return []
    first = settings["scenes"][0]
    return [one for what in SEQUENCES for one in frame_sets.parts(layout, first, frame_set, what)]


def widths(layout: Layout, frame_set: str) -> list[str]:
    """How wide the penumbrae of its test frames are; none of an engine's frames without targets."""
    engine = layout.entry("frame_sets", frame_set).get("engine")
    known = engine is None or engine["targets"]
    return [layout.paths.penumbra_widths(frame_set)] if known else []


def first_tests(layout: Layout, frame_set: str) -> list[str]:
    """The first part of each scene's test frames."""
    scenes = frame_sets.measured_scenes(layout, frame_set)
    return [frame_sets.parts(layout, scene, frame_set, "test")[0] for scene in scenes]


def timed_parts(layout: Layout, table: str) -> list[str]:
    """The parts whose first frames are timed: of the first two scenes."""
    return first_tests(layout, frame_set(layout, table))[:2]


def timed_meshes(layout: Layout, table: str) -> list[str]:
    """The meshes that stand in the scenes of a table."""
    return all_meshes(layout, frame_set(layout, table))


def timed_generators(layout: Layout, table: str) -> list[str]:
    """The generators of those scenes."""
    return all_generators(layout, frame_set(layout, table))


def all_generators(layout: Layout, frame_set: str) -> list[str]:
    """The generators of a frame set's scenes."""
    return frame_sets.generators(layout, frame_sets.measured_scenes(layout, frame_set))


def labels(layout: Layout, table: str) -> dict[str, str]:
    """What each method of a table is called."""
    return {method: label(layout, method) for method in methods(layout, table)}


def label(layout: Layout, method: str) -> str:
    """What a method is called."""
    if not is_network(method):
        return LABELS[method]
    by_scene, one = (layout.settings[key] for key in ("networks_by_scene", "screen_experiments"))
    return (by_scene if method in by_scene else one)[method]["label"]


def weights(layout: Layout, method: str) -> list[str]:
    """The files of the weights of a network, or of a network for each scene; none of another method."""
    file = "weights.safetensors"
    return [layout.paths.screen_network(file, name) for name in experiments(layout, method)]


def experiments(layout: Layout, method: str) -> list[str]:
    """The experiments that a method is: one of a network, several of one for each scene, or none."""
    if not is_network(method):
        return []
    by_scene = layout.settings["networks_by_scene"]
    if method in by_scene:
        return by_scene[method]["experiments"]
    return [_of_formats(layout).get(method, (method, "auto"))[0]]


def forms(layout: Layout, methods: Iterable[str]) -> set[str]:
    """The forms of the networks among some methods."""
    names = [name for method in methods for name in experiments(layout, method)]
    return screen_networks.forms(layout, names)


def by_scene(layout: Layout, method: str) -> bool:
    """Whether a method is a network for each scene, and has no answer for any other."""
    return method in layout.settings["networks_by_scene"]


def precision(layout: Layout, method: str) -> str:
    """The number format that a network is asked in."""
    return _of_formats(layout).get(method, (method, "auto"))[1]


def _of_formats(layout: Layout) -> dict[str, tuple[str, str]]:
    """By method the experiment and the number format that it is, of those that name one."""
    known = layout.settings["screen_experiments"]
    return {in_format(name, one): (name, one) for name in known for one in FORMATS}


def timed_methods(layout: Layout, table: str) -> dict[str, str | None]:
    """The methods of a table, and of each the experiment that is timed: of several the first."""
    return {one: next(iter(experiments(layout, one)), None) for one in methods(layout, table)}


def timed_weights(layout: Layout, table: str) -> list[str]:
    """The weights of the networks of a table that are timed."""
    return [
        layout.paths.screen_network("weights.safetensors", name)
        for name in timed_methods(layout, table).values()
        if name
    ]


def trainings(layout: Layout, table: str) -> list[str]:
    """training.json of the networks of a table."""
    names = [name for method in methods(layout, table) for name in experiments(layout, method)]
    return [layout.paths.screen_network("training.json", name) for name in names]


def shown_scenes(layout: Layout, table: str) -> list[str]:
    """The scenes whose test frames a table is of."""
    settings = layout.entry("tables", table)
    match settings.get("over"):  # of a summary
        case "trained":
            return frame_sets.tuned_scenes(layout, settings["frame_set"])
        case "unseen":
            return layout.entry("frame_sets", settings["frame_set"])["unseen"]
    return frame_sets.measured_scenes(layout, settings["frame_set"])


def radii(layout: Layout, table: str) -> list[str]:
    """The radii of a table's frame set as texts."""
    settings = layout.entry("frame_sets", frame_set(layout, table))
    unit = {"metres": "m", "scene_sizes": "S"}[settings["radius_unit"]]
    return [f"{radius:.3g} {unit}" for radius in settings["radii"]]


def times(layout: Layout, table: str) -> list[str]:
    """The times of a table; none of one without a column for them, or of frames of a user's own, where
    there is no scene to ask.
    """
    own = layout.entry("frame_sets", frame_set(layout, table))["path"] is not None
    timed = "time" in layout.entry("tables", table).get("metrics", ["time"])
    return [layout.paths.soft_times(table)] if timed and not own else []
