"""What each kind of table is made of: its files, and what its function is told."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from neural_shadows.evaluation.costs import STAGES
from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT

Row = Mapping[str, Any]

PUBLISHED = ("comparison", "frame_times", "memory")
"""Kinds whose values stand beside the thesis's."""


def files(layout: Layout, table: str) -> dict[str, Any]:
    """The files that a table is made of, as its kind's function names them."""
    settings = layout.entry("tables", table)
    rows, paths = settings["rows"], layout.paths
    scenes = unique(row["scene"] for row in rows)
    match settings["kind"]:
        case "comparison":
            found = {
                "metrics": metrics(layout, rows),
                "mesh_json": paths.scene("mesh.json", scenes[0]),
                "trainings": networks(layout, rows, "training.json"),
                "depth_biases": depth_biases(layout, rows),
                "lpips_json": paths.lpips,
            }
        case "frame_times":
            found = {
                "times": [paths.frame_times(table, scene) for scene in scenes],
                "metrics": metrics(layout, rows),
                "weights": networks(layout, rows, "weights.safetensors"),
                "meshes": [paths.scene("mesh.json", scene) for scene in scenes],
                "lpips_json": paths.lpips,
            }
        case "networks":
            found = {
                "times": [paths.frame_times(table, scene) for scene in scenes],
                "metrics": metrics(layout, rows),
                "weights": networks(layout, rows, "weights.safetensors"),
                "trainings": networks(layout, rows, "training.json"),
                "depth_biases": depth_biases(layout, rows),
                "meshes": [paths.scene("mesh.json", scene) for scene in scenes],
                "lpips_json": paths.lpips,
            }
        case "memory":
            found = {
                "mesh_ply": paths.scene("mesh.ply", scenes[0]),
                "weights": networks(layout, rows, "weights.safetensors"),
            }
        case "cost":
            found = {"costs": costs(layout, table)}
    if settings["kind"] in PUBLISHED:
        found["published_csv"] = layout.source("config/published.csv")
    # Not read: asking for a table makes the figures and the previews that belong to it.
    beside = [paths.report(f"{name}.png") for name in settings["figures"]]
    if settings["kind"] == "comparison":
        beside += [paths.report(f"scenes/{scene}.png") for scene in scenes]
    return found | {"beside": beside}


def arguments(layout: Layout, table: str) -> dict[str, Any]:
    """What the function of a table's kind is told beside its files."""
    settings = layout.entry("tables", table)
    told = {"title": settings["title"], "run": layout.run()}
    if settings["kind"] == "cost":
        return told
    told["rows"] = settings["rows"]
    if settings["kind"] in PUBLISHED:
        told["published"] = settings["published"]
    if settings["kind"] in ("comparison", "networks"):
        told["scenes"] = layout.scenes(row["scene"] for row in settings["rows"])
    return told


def kind(layout: Layout, table: str) -> str:
    """A table's kind."""
    return layout.entry("tables", table)["kind"]


def labels(layout: Layout, table: str) -> dict[str, str]:
    """What Snakemake's report lists of a table: the thesis's number and the title."""
    settings = layout.entry("tables", table)
    return {"table": settings["published"] or table, "title": settings["title"]}


def experiments(layout: Layout, table: str) -> list[str]:
    """The networks whose weights a table reads, each once."""
    if kind(layout, table) == "comparison":
        return []
    return experiments_of(layout.entry("tables", table)["rows"])


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


def experiments_of(rows: Sequence[Row]) -> list[str]:
    """The networks among the rows, each once."""
    return unique(row["experiment"] for row in rows if row["experiment"] is not None)


def metrics(layout: Layout, rows: Sequence[Row], ending: str = "csv") -> list[str]:
    """The metrics of all batches of the rows' methods, each once; a ray-traced one has none."""
    return unique(
        path
        for row in rows
        if row["method"] != RAY_TRACED
        for path in layout.evaluations(row["scene"], row["method"], ending)
    )


def networks(layout: Layout, rows: Sequence[Row], file: str) -> list[str]:
    """A file of each network among the rows, each once."""
    return [layout.paths.network(file, name) for name in experiments_of(rows)]


def depth_biases(layout: Layout, rows: Sequence[Row]) -> list[str]:
    """The depth bias of each network among the rows that has one found, each once."""
    return unique(
        layout.paths.depth_bias(row["experiment"]) for row in rows if row["bias"] == HELD_OUT
    )


def costs(layout: Layout, table: str) -> list[str]:
    """The measurements of a table of costs, a file for each size."""
    settings = layout.entry("tables", table)
    return [layout.paths.cost(over, value) for over in STAGES for value in settings[over]]


def unique(values: Iterable[Any]) -> list[Any]:
    """Each value once, in order."""
    return list(dict.fromkeys(values))
