"""Files of tables: rows on scenes, methods on frame sets."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.evaluation.registry import LABELS, RAY_TRACED, available, biased_key, unbiased
from neural_shadows.layout import frame_methods, frame_sets
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT, batches, part_names
from neural_shadows.layout.paths import ALL
from neural_shadows.sections.frame_sets import VIEWS

Row = Mapping[str, Any]


def timed_rows(layout: Layout, table: str, scene: str) -> list[Row]:
    """Rows of a table timed on a scene."""
    return [row for row in layout.entry("tables", table)["rows"] if row["scene"] == scene]


def evaluations(layout: Layout, rows: Sequence[Row], ending: str) -> list[str]:
    """Evaluation files of all batches of the rows' methods, except ray tracing.

    Args:
        ending: `csv` of metrics, `npz` of visibilities.
    """
    methods = [(row["scene"], row["method"]) for row in rows if row["method"] != RAY_TRACED]
    parts = batches(layout.views)
    groups = [(f"{scene}.{part}", method) for scene, method in methods for part in parts]
    return unique(layout.paths.evaluation(ending, VIEWS, method, group) for group, method in groups)


def references(layout: Layout, scenes: Iterable[str]) -> list[str]:
    """References of all batches of scenes, without held-out ones."""
    parts = batches(layout.views)
    return [layout.paths.reference(scene, part) for scene in scenes for part in parts]


def networks(layout: Layout, rows: Sequence[Row], file: str) -> list[str]:
    """A file of each network among the rows, each once."""
    return [layout.paths.network(file, name) for name in experiments_of(rows)]


def depth_biases(layout: Layout, rows: Sequence[Row]) -> list[str]:
    """Held-out depth biases of the rows' methods, each once."""
    methods = [(row["scene"], unbiased(row["method"])) for row in rows if row["bias"] == HELD_OUT]
    return unique(layout.paths.constants(VIEWS, method, scene) for scene, method in methods)


def curves(layout: Layout, rows: Sequence[Row]) -> dict[str, list[dict[str, Any]]]:
    """Points of the learning curves of the rows' networks."""
    points = layout.settings["learning_curves"]
    return {name: points[name] for name in experiments_of(rows) if name in points}


def with_curves(layout: Layout, rows: Sequence[Row]) -> list[Row]:
    """Rows, and rows of all points of their learning curves."""
    extended = list(rows)
    for row in rows:
        for point in layout.settings["learning_curves"].get(row["experiment"], ()):
            name = point["experiment"]
            method = name if row["method"] == row["experiment"] else biased_key(name)
            extended.append({**row, "method": method, "experiment": name})
    return extended


def unshadowed(scenes: Iterable[str]) -> list[Row]:
    """Rows of the unshadowed null predictor, per scene."""
    row = {"method": NO_SHADOW, "experiment": None, "bias": None}
    return [{**row, "scene": scene} for scene in scenes]


def before_training(layout: Layout, experiment: str) -> list[str]:
    """Benchmarks of the jobs before an experiment's training.

    Params and no inputs: changed times must not rebuild anything.
    """
    settings, folder = layout.on_rays(experiment), layout.paths.benchmarks
    scene, sampling = settings["scene"], settings["sampling"]
    jobs = [("prepare_mesh", scene)]
    if sampling is not None:  # None without training
        shards = part_names(layout.entry("samplings", sampling)["shards"])
        jobs.append(("draw_directions", scene, sampling))
        jobs += [("sample_rays", scene, sampling, shard) for shard in shards]
    return [f"{folder}/{rule}/{'.'.join(names)}.tsv" for rule, *names in jobs]


def experiments_of(rows: Sequence[Row]) -> list[str]:
    """Experiments among the rows, each once."""
    return unique(row["experiment"] for row in rows if row.get("experiment") is not None)


def unique(values: Iterable[Any]) -> list[Any]:
    """Each value once, in order."""
    return list(dict.fromkeys(values))


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


def constants(layout: Layout, table: str) -> list[str]:
    """Files of chosen constants of a table's methods, in order."""
    frames = frame_set(layout, table)
    paths = (
        path
        for method in methods(layout, table)
        for path in frame_methods.chosen(layout, frames, method)
    )
    return list(dict.fromkeys(paths))


def profiled_formats(layout: Layout, network: str) -> list[str] | None:
    """Number formats in which tables show a network's whole frames; None where one shows its levels."""
    tables = layout.settings["tables"].values()
    steps = (step for table in tables for step in table.get("steps", {}).values())
    formats = unique(step["precision"] for step in steps if step["network"] == network)
    by_level = any(table.get("network") == network for table in tables)
    return None if by_level or not formats else formats


def widths(layout: Layout, frame_set: str) -> list[str]:
    """File of penumbra widths; none without targets."""
    engine = layout.frames(frame_set).get("engine")
    has_targets = engine is None or engine["targets"]
    return [layout.paths.frame_measure("widths.json", frame_set)] if has_targets else []


def shown_scenes(layout: Layout, table: str) -> list[str]:
    """Scenes of a table's test frames."""
    settings = layout.entry("tables", table)
    match settings.get("over"):  # of a summary
        case "trained":
            return frame_sets.tuned_scenes(layout, settings["frame_set"])
        case "unseen":
            return layout.frames(settings["frame_set"])["unseen"]
    return frame_sets.measured_scenes(layout, settings["frame_set"])


def lights(layout: Layout, table: str) -> list[int]:
    """Numbers of the radii that count in a table's means."""
    settings = layout.entry("tables", table)
    return settings.get("lights") or [*range(len(layout.frames(settings["frame_set"])["radii"]))]


def times(layout: Layout, table: str) -> list[str]:
    """Times of a table; none without a column, or of a user's frames."""
    own = layout.frames(frame_set(layout, table))["path"] is not None
    timed = "time" in layout.entry("tables", table).get("metrics", ["time"])
    return [layout.paths.times(table, ALL)] if timed and not own else []
