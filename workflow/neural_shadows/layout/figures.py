"""What each kind of figure is made of: its files, and what its function is told."""

from collections.abc import Iterable
from typing import Any

from neural_shadows.evaluation.soft_method_names import available
from neural_shadows.layout import frame_sets, soft_methods, tables
from neural_shadows.layout.layout import Layout

# What a kind's function is told beside its title; those that are not here, the scene alone.
TOLD = {
    "pictures": ("rows", "view_sets", "run"),
    "contact_sheet": ("rows", "run"),
    "errors_3d": ("scene", "rows", "run", "device", "precision"),
    "loss": ("curves", "run"),
    "widths": ("rows", "run"),
    "pareto": ("scene", "costs", "rows", "run"),
    "learning_curves": ("rows", "run"),
    "cost": ("run",),
    "view_directions": ("seed",),
    "overview": ("scene", "sampling", "seed"),
    "quadtree": ("scene", "sampling", "seed"),
    "soft_equal_time": ("radii", "run"),
    "soft_pictures": ("labels", "radii", "run"),
    "soft_radii": ("run",),
    "penumbra_model": ("run",),
    "screen_level_time": ("run",),
    "screen_sensitivity": ("run",),
    "screen_flicker": ("labels", "run"),
    "forest": ("ups", "instances", "resolution", "seed", "run"),
}


def files(layout: Layout, figure: str) -> dict[str, Any]:
    """The files that a figure is made of, as its kind's function names them."""
    settings, paths = layout.entry("figures", figure), layout.paths
    kind, scene = settings["kind"], _scene(layout, figure)
    mesh_ply = {"mesh_ply": paths.scene("mesh.ply", scene)}
    mesh = mesh_ply | {"mesh_json": paths.scene("mesh.json", scene)}
    match kind:
        case "pictures" | "contact_sheet":
            rows = settings["rows"]
            files = {
                "metrics": tables.metrics(layout, rows),
                "references": tables.references(layout, [scene]),
                "visibilities": tables.visibilities(layout, rows),
                "mesh_json": mesh["mesh_json"],
            }
            if kind == "pictures":  # which say whether a network has learned
                files["metrics"] += tables.metrics(layout, tables.unshadowed([scene]))
                files["published_csv"] = layout.source("config/published.csv")
            return files
        case "errors_3d":
            return mesh_ply | {
                "references": paths.reference(scene, "000"),
                "weights": tables.networks(layout, settings["rows"], "weights.safetensors"),
                "depth_biases": tables.depth_biases(layout, settings["rows"]),
            }
        case "field_slice" | "field_3d" | "depth_sheets_3d":
            weights = paths.network("weights.safetensors", settings["experiment"])
            return mesh_ply | {"weights": weights}
        case "loss":
            curves = settings["curves"]
            return {
                "losses": tables.networks(layout, curves, "loss.csv"),
                "trainings": tables.networks(layout, curves, "training.json"),
            }
        case "widths" | "pareto" | "learning_curves" | "soft_equal_time" | "soft_radii":
            return {"table": paths.report(f"{settings['table']}.csv")}
        case "screen_level_time" | "screen_sensitivity":
            return {"table": paths.report(f"{settings['table']}.csv")}
        case "soft_pictures":
            frame_set = soft_methods.frame_set(layout, settings["table"])
            return {
                "part": frame_sets.parts(layout, settings["soft_scene"], frame_set, "test")[0],
                "answers": [
                    paths.soft_evaluation("npz", frame_set, method)
                    for method in filter(available, settings["methods"])
                ],
            }
        case "screen_flicker":
            frame_set = soft_methods.frame_set(layout, settings["table"])
            return {
                "parts": soft_methods.sequences(layout, frame_set),
                "answers": [
                    paths.soft_evaluation("npz", frame_set, method)
                    for method in settings["methods"]
                ],
            }
        case "penumbra_model":
            return {
                "parts": soft_methods.first_tests(layout, settings["frame_set"]),
                "meshes": soft_methods.all_meshes(layout, settings["frame_set"]),
            }
        case "cost":
            return {"costs": tables.costs(layout, settings["table"])}
        case "view_directions":
            return {}
        case "forest":
            return {
                name: [paths.scene(file, one) for one in settings["scenes"]]
                for name, file in (("meshes", "mesh.ply"), ("reports", "mesh.json"))
            }
        case "scene_3d":
            names = scene, settings["sampling"]
            directions = {"directions_npy": paths.rays("directions.npy", *names)}
            return mesh | directions | layout.shards(*names)
        case _:  # a picture of the method
            return mesh


def arguments(layout: Layout, figure: str) -> dict[str, Any]:
    """What the function of a figure's kind is told beside its files."""
    settings, scene = layout.entry("figures", figure), _scene(layout, figure)
    values = {**settings, "run": layout.run(), "seed": layout.settings["seed"]}
    values |= {key: layout.settings["compute"][key] for key in ("device", "precision")}
    if scene is not None:
        values["seed"] = layout.entry("scenes", scene)["seed"]
    if scene is not None and settings["kind"] != "pareto":
        values["scene"] = layout.entry("scenes", scene)["scene"]
    if settings["kind"] in ("soft_pictures", "screen_flicker"):
        some = filter(available, settings["methods"])
        values["labels"] = {one: soft_methods.label(layout, one) for one in some}
    if settings["kind"] == "forest":
        values["ups"] = [layout.entry("scenes", one)["scene"]["up"] for one in settings["scenes"]]
    if "sampling" in settings:
        values["sampling"] = layout.entry("samplings", settings["sampling"])
    return {key: values[key] for key in ("title", *TOLD.get(settings["kind"], ("scene",)))}


def soft_picture_files(layout: Layout, figures: Iterable[str]) -> dict[str, list[str]]:
    """What those among some figures that show frames of soft shadows are made of, each once."""
    entries = layout.settings["figures"]
    shown = [files(layout, name) for name in figures if entries[name]["kind"] == "soft_pictures"]
    return {
        "soft_parts": tables.unique(one["part"] for one in shown),
        "soft_answers": tables.unique(path for one in shown for path in one["answers"]),
    }


def soft_pictures(layout: Layout) -> list[dict[str, Any]]:
    """Which frames of soft shadows figures show, as `soft_comparisons` takes them."""
    found = []
    for name, figure in layout.settings["figures"].items():
        if figure["kind"] == "soft_pictures":
            told, table = arguments(layout, name), figure["table"]
            found.append(
                {
                    "table": table,
                    "title": layout.entry("tables", table)["title"],
                    "frame_set": soft_methods.frame_set(layout, table),
                    "scene": figure["soft_scene"],
                    "labels": told["labels"],
                    "radii": told["radii"],
                }
            )
    return found


def _scene(layout: Layout, figure: str) -> str | None:
    settings = layout.entry("figures", figure)
    if "experiment" in settings:
        return layout.entry("experiments", settings["experiment"])["scene"]
    return settings.get("scene")


def asks_networks(layout: Layout, figure: str) -> bool:
    """Whether a figure's job may compute networks on a GPU."""
    return layout.entry("figures", figure)["kind"] == "errors_3d"


def labels(layout: Layout, figure: str) -> dict[str, str]:
    """What Snakemake's report lists of a figure."""
    number = figure.removeprefix("figure_").replace("_", ".")
    return {"figure": number, "title": layout.entry("figures", figure)["title"]}


def encodings(layout: Layout, figure: str) -> set[str]:
    """The kinds of the networks whose weights a figure reads."""
    settings = layout.entry("figures", figure)
    rows = settings["rows"] if settings["kind"] == "errors_3d" else [settings]
    return layout.encodings(tables.experiments_of(rows))


def generators(layout: Layout, figure: str) -> list[str]:
    """The generators of the scenes that a figure looks into."""
    settings = layout.entry("figures", figure)
    if settings["kind"] != "penumbra_model":
        return []
    return soft_methods.all_generators(layout, settings["frame_set"])
