"""What each kind of table is made of: its files, and what its function is told."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from neural_shadows.evaluation.costs import STAGES
from neural_shadows.evaluation.method_names import NO_SHADOW, RAY_TRACED, biased_key, unbiased
from neural_shadows.layout import screen_tables, soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT, batches, part_names

Row = Mapping[str, Any]

# What a kind's function is made of and told beside its title.
FILES = {
    "comparison": (
        "metrics",
        "mesh_json",
        "trainings",
        "depth_biases",
        "lpips_json",
        "published_csv",
    ),
    "frame_times": ("times", "metrics", "weights", "meshes", "lpips_json", "published_csv"),
    "networks": (
        "times",
        "metrics",
        "weights",
        "trainings",
        "depth_biases",
        "meshes",
        "lpips_json",
        "published_csv",
    ),
    "learning_curves": ("metrics", "losses", "trainings", "meshes", "lpips_json", "published_csv"),
    "memory": ("weights", "published_csv"),
    "cost": ("costs",),
    "soft_methods": (
        "frames_json",
        "soft_metrics",
        "soft_times",
        "soft_constants",
        "widths_json",
        "lpips_json",
    ),
    "soft_summary": (
        "frames_json",
        "soft_metrics",
        "soft_times",
        "widths_json",
        "trainings",
        "published_kpnsm_csv",
    ),
    "penumbra_widths": ("parts", "meshes"),
    "penumbra_feature": ("parts",),
    "screen_levels": ("profile_json", "published_nsm_csv"),
    "screen_parts": ("profile_json", "published_nsm_csv"),
    "screen_networks": ("published_nsm_csv",),
    "screen_depth": (
        "soft_metrics",
        "trainings",
        "frames_json",
        "published_nsm_csv",
        "widths_json",
    ),
    "screen_features": (
        "soft_metrics",
        "trainings",
        "sensitivities",
        "published_nsm_csv",
        "widths_json",
    ),
    "screen_errors": ("soft_metrics", "trainings", "frames_json", "widths_json"),
    "screen_solids": ("soft_metrics", "trainings", "frames_json", "widths_json"),
    "screen_steps": ("profiles", "soft_metrics", "trainings", "published_nsm_csv", "widths_json"),
    "screen_temporal": ("soft_metrics", "trainings", "frames_json", "widths_json"),
}
TOLD = {
    "comparison": ("published", "against", "rows", "run", "scenes"),
    "frame_times": ("published", "rows", "run"),
    "networks": ("against", "durations", "rows", "run", "scenes"),
    "learning_curves": ("published", "rows", "curves", "run", "scenes"),
    "memory": ("published", "rows", "run"),
    "cost": ("run",),
    "soft_methods": ("labels", "left_out", "unseen", "run"),
    "soft_summary": ("published", "methods", "by", "metrics", "measured", "run"),
    "penumbra_widths": ("run",),
    "penumbra_feature": ("run",),
    "screen_levels": ("published", "run"),
    "screen_parts": ("published", "run"),
    "screen_networks": ("published", "networks", "run"),
    "screen_depth": ("published", "columns", "labels", "run"),
    "screen_features": ("published", "columns", "labels", "run"),
    "screen_errors": ("labels", "run"),
    "screen_solids": ("labels", "run"),
    "screen_steps": ("published", "steps", "labels", "run"),
    "screen_temporal": ("labels", "run"),
}


def files(layout: Layout, table: str) -> dict[str, Any]:
    """The files that a table is made of, as its kind's function names them."""
    settings, paths = layout.entry("tables", table), layout.paths
    kind, rows = settings["kind"], settings["rows"]
    scenes = unique(row["scene"] for row in rows)
    reports = [paths.scene("mesh.json", scene) for scene in scenes]
    if kind == "learning_curves":
        rows = [*with_curves(layout, rows), *unshadowed(scenes)]
    values = {
        "metrics": metrics(layout, rows),
        "losses": networks(layout, rows, "loss.csv"),
        "mesh_json": reports[:1],
        "meshes": reports,
        "trainings": networks(layout, rows, "training.json"),
        "weights": networks(layout, rows, "weights.safetensors"),
        "depth_biases": depth_biases(layout, rows),
        "times": [paths.frame_times(table, scene) for scene in scenes],
        "lpips_json": paths.lpips,
        "published_csv": layout.source("config/published.csv"),
        "published_nsm_csv": layout.source("config/published_nsm.csv"),
        "published_kpnsm_csv": layout.source("config/published_kpnsm.csv"),
        "costs": costs(layout, table) if kind == "cost" else [],
        "profile_json": paths.screen_profile(settings["network"]) if "network" in settings else [],
    }
    if kind in ("soft_methods", "soft_summary"):
        values["soft_metrics"] = soft_methods.evaluations(layout, table, "csv")
        values["soft_times"] = soft_methods.times(layout, table)
        values["frames_json"] = soft_methods.tests(layout, settings["frame_set"])[0]
        values["widths_json"] = soft_methods.widths(layout, settings["frame_set"])
        values["soft_constants"] = soft_methods.constants(layout, table)
    if kind == "soft_summary":
        values["trainings"] = soft_methods.trainings(layout, table)
    if kind == "penumbra_widths":
        values["parts"] = soft_methods.first_tests(layout, settings["frame_set"])
        values["meshes"] = soft_methods.all_meshes(layout, settings["frame_set"])
    if kind == "penumbra_feature":
        values["parts"] = soft_methods.tests(layout, settings["frame_set"])
    if kind in screen_tables.KINDS:
        values |= screen_tables.files(layout, table)
    found = {name: values[name] for name in FILES[kind]}
    # Not read: asking for a table makes the figures and the previews that belong to it.
    found["beside"] = [paths.report(f"{name}.png") for name in settings["figures"]]
    if kind == "comparison":
        found["beside"] += [paths.report(f"scenes/{scene}.png") for scene in scenes]
    return found


def arguments(layout: Layout, table: str) -> dict[str, Any]:
    """What the function of a table's kind is told beside its files."""
    settings = layout.entry("tables", table)
    rows = settings["rows"]
    values = {
        **settings,
        "run": layout.run(),
        "scenes": layout.scenes(row["scene"] for row in rows),
        "curves": curves(layout, rows),
        "durations": {name: before_training(layout, name) for name in experiments_of(rows)},
    }
    if settings["kind"] == "soft_methods":
        frame_set = layout.entry("frame_sets", settings["frame_set"])
        values["labels"] = soft_methods.labels(layout, table)
        values["left_out"] = soft_methods.left_out(layout, table)
        values["unseen"] = frame_set.get("unseen", [])
    if settings["kind"] == "soft_summary":
        values["methods"] = [
            row | {"label": row["label"] or soft_methods.label(layout, row["method"])}
            for row in settings["methods"]
            if row["method"] in soft_methods.methods(layout, table)
        ]
        values["measured"] = soft_methods.shown_scenes(layout, table)
    if settings["kind"] in screen_tables.KINDS:
        values["labels"] = screen_tables.labels(layout, table)
    if settings["kind"] == "screen_networks":
        values["networks"] = [_screen_network(layout, row) for row in settings["networks"]]
    return {key: values[key] for key in ("title", *TOLD[settings["kind"]])}


def _screen_network(layout: Layout, row: Row) -> dict[str, Any]:
    """A network of whole frames: its name, its row in the paper, its settings."""
    name = row["network"]
    settings = layout.entry("screen_networks", name)
    return {"name": name, "published": row["published"] or name, "settings": settings}


def labels(layout: Layout, table: str) -> dict[str, str]:
    """What Snakemake's report lists of a table: the thesis's number and the title."""
    settings = layout.entry("tables", table)
    return {"table": settings["published"] or table, "title": settings["title"]}


def encodings(layout: Layout, table: str) -> set[str]:
    """The kinds of the networks whose weights a table reads."""
    settings = layout.entry("tables", table)
    reads = "weights" in FILES[settings["kind"]]
    return layout.encodings(experiments_of(settings["rows"]) if reads else [])


def generators(layout: Layout, table: str) -> list[str]:
    """The generators of the scenes that a table looks into."""
    settings = layout.entry("tables", table)
    if settings["kind"] != "penumbra_widths":
        return []
    return soft_methods.all_generators(layout, settings["frame_set"])


def timed_rows(layout: Layout, table: str, scene: str) -> list[Row]:
    """The rows whose methods are timed on a scene for a table."""
    return [row for row in layout.entry("tables", table)["rows"] if row["scene"] == scene]


def timed_methods(layout: Layout, table: str, scene: str) -> list[str]:
    """The methods of `timed_rows`."""
    return [row["method"] for row in timed_rows(layout, table, scene)]


def timed_weights(layout: Layout, table: str, scene: str) -> list[str]:
    """The weights of the networks among them."""
    return networks(layout, timed_rows(layout, table, scene), "weights.safetensors")


def timed_encodings(layout: Layout, table: str, scene: str) -> set[str]:
    """The kinds of those networks."""
    return layout.encodings(experiments_of(timed_rows(layout, table, scene)))


def metrics(layout: Layout, rows: Sequence[Row]) -> list[str]:
    """The metrics of all batches of the rows' methods, each once; a ray-traced one has none."""
    return _evaluations(layout, rows, "csv")


def visibilities(layout: Layout, rows: Sequence[Row]) -> list[str]:
    """The same methods' visibilities."""
    return _evaluations(layout, rows, "npz")


def _evaluations(layout: Layout, rows: Sequence[Row], ending: str) -> list[str]:
    methods = [(row["scene"], row["method"]) for row in rows if row["method"] != RAY_TRACED]
    parts = batches(layout.settings["rendering"])
    return unique(layout.paths.evaluation(ending, *one, part) for one in methods for part in parts)


def references(layout: Layout, scenes: Iterable[str]) -> list[str]:
    """All batches of viewpoints of some scenes that methods are measured on."""
    parts = batches(layout.settings["rendering"])
    return [layout.paths.reference(scene, part) for scene in scenes for part in parts]


def networks(layout: Layout, rows: Sequence[Row], file: str) -> list[str]:
    """A file of each network among the rows, each once."""
    return [layout.paths.network(file, name) for name in experiments_of(rows)]


def depth_biases(layout: Layout, rows: Sequence[Row]) -> list[str]:
    """The depth bias of each method among the rows that has one found, each once."""
    found = [(row["scene"], unbiased(row["method"])) for row in rows if row["bias"] == HELD_OUT]
    return unique(layout.paths.depth_bias(*names) for names in found)


def curves(layout: Layout, rows: Sequence[Row]) -> dict[str, list[dict[str, Any]]]:
    """The points of the learning curve of each network among the rows that has one."""
    found = layout.settings["learning_curves"]
    return {name: found[name] for name in experiments_of(rows) if name in found}


def with_curves(layout: Layout, rows: Sequence[Row]) -> list[Row]:
    """The rows, and those of all points of their networks' learning curves."""
    found = list(rows)
    for row in rows:
        for point in layout.settings["learning_curves"].get(row["experiment"], ()):
            name = point["experiment"]
            method = name if row["method"] == row["experiment"] else biased_key(name)
            found.append({**row, "method": method, "experiment": name})
    return found


def unshadowed(scenes: Iterable[str]) -> list[Row]:
    """What networks have to be better than on each scene, as rows."""
    row = {"method": NO_SHADOW, "experiment": None, "bias": None}
    return [{**row, "scene": scene} for scene in scenes]


def before_training(layout: Layout, experiment: str) -> list[str]:
    """The benchmarks of the jobs between a mesh's file and an experiment's training.

    They are told and are no inputs: nothing is made again for the seconds that it took.
    """
    settings, folder = layout.entry("experiments", experiment), layout.paths.benchmarks
    scene, sampling = settings["scene"], settings["sampling"]
    jobs = [("prepare_mesh", scene)]
    if sampling is not None:  # of a network that is only built
        shards = part_names(layout.entry("samplings", sampling)["shards"])
        jobs.append(("draw_directions", scene, sampling))
        jobs += [
            (rule, scene, sampling, shard)
            for rule in ("sample_rays", "label_rays")
            for shard in shards
        ]
    return [f"{folder}/{rule}/{'.'.join(names)}.tsv" for rule, *names in jobs]


def costs(layout: Layout, table: str) -> list[str]:
    """The measurements of a table of costs, a file for each size."""
    settings = layout.entry("tables", table)
    return [layout.paths.cost(over, value) for over in STAGES for value in settings[over]]


def experiments_of(rows: Sequence[Row]) -> list[str]:
    """The networks among the rows, each once."""
    return unique(row["experiment"] for row in rows if row.get("experiment") is not None)


def unique(values: Iterable[Any]) -> list[Any]:
    """Each value once, in order."""
    return list(dict.fromkeys(values))
