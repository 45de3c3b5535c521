"""Files of rows: metrics, visibilities, networks, depth biases, learning curves."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from neural_shadows.evaluation.method_names import RAY_TRACED, biased_key, unbiased
from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT, batches, part_names

Row = Mapping[str, Any]


def timed_rows(layout: Layout, table: str, scene: str) -> list[Row]:
    """Rows of a table timed on a scene."""
    return [row for row in layout.entry("tables", table)["rows"] if row["scene"] == scene]


def timed_methods(layout: Layout, table: str, scene: str) -> list[str]:
    """Methods of `timed_rows`."""
    return [row["method"] for row in timed_rows(layout, table, scene)]


def timed_weights(layout: Layout, table: str, scene: str) -> list[str]:
    """Weights of the networks in `timed_rows`."""
    return networks(layout, timed_rows(layout, table, scene), "weights.safetensors")


def timed_encodings(layout: Layout, table: str, scene: str) -> set[str]:
    """Kinds of the networks in `timed_rows`."""
    return layout.encodings(experiments_of(timed_rows(layout, table, scene)))


def metrics(layout: Layout, rows: Sequence[Row]) -> list[str]:
    """Metrics of all batches of the rows' methods, except ray tracing."""
    return _evaluations(layout, rows, "csv")


def visibilities(layout: Layout, rows: Sequence[Row]) -> list[str]:
    """Visibilities of all batches of the rows' methods, except ray tracing."""
    return _evaluations(layout, rows, "npz")


def _evaluations(layout: Layout, rows: Sequence[Row], ending: str) -> list[str]:
    methods = [(row["scene"], row["method"]) for row in rows if row["method"] != RAY_TRACED]
    parts = batches(layout.settings["rendering"])
    return unique(layout.paths.evaluation(ending, *m, part) for m in methods for part in parts)


def references(layout: Layout, scenes: Iterable[str]) -> list[str]:
    """References of all batches of scenes, without held-out ones."""
    parts = batches(layout.settings["rendering"])
    return [layout.paths.reference(scene, part) for scene in scenes for part in parts]


def networks(layout: Layout, rows: Sequence[Row], file: str) -> list[str]:
    """A file of each network among the rows, each once."""
    return [layout.paths.network(file, name) for name in experiments_of(rows)]


def depth_biases(layout: Layout, rows: Sequence[Row]) -> list[str]:
    """Held-out depth biases of the rows' methods, each once."""
    methods = [(row["scene"], unbiased(row["method"])) for row in rows if row["bias"] == HELD_OUT]
    return unique(layout.paths.depth_bias(*names) for names in methods)


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
    settings, folder = layout.entry("experiments", experiment), layout.paths.benchmarks
    scene, sampling = settings["scene"], settings["sampling"]
    jobs = [("prepare_mesh", scene)]
    if sampling is not None:  # None without training
        shards = part_names(layout.entry("samplings", sampling)["shards"])
        jobs.append(("draw_directions", scene, sampling))
        jobs += [
            (rule, scene, sampling, shard)
            for rule in ("sample_rays", "label_rays")
            for shard in shards
        ]
    return [f"{folder}/{rule}/{'.'.join(names)}.tsv" for rule, *names in jobs]


def experiments_of(rows: Sequence[Row]) -> list[str]:
    """Experiments among the rows, each once."""
    return unique(row["experiment"] for row in rows if row.get("experiment") is not None)


def unique(values: Iterable[Any]) -> list[Any]:
    """Each value once, in order."""
    return list(dict.fromkeys(values))
