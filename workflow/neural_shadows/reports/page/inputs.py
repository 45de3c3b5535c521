"""Files and arguments of a run's page, and of a page of what there is."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from neural_shadows.evaluation.registry import RAY_TRACED
from neural_shadows.layout import kinds, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.shown_meshes import shown_meshes
from neural_shadows.reports.claims import inputs as claims
from neural_shadows.reports.data.method_look import kind_of
from neural_shadows.reports.figures import soft_pictures
from neural_shadows.reports.targets import default_figures, default_tables


def page_inputs(layout: Layout, page: str) -> dict[str, Any]:
    """Files that a page waits for."""
    return page_files(layout) if page == "index" else {}


def page_settings(layout: Layout, page: str) -> dict[str, Any]:
    """Arguments of `write_page` beside what the page waits for."""
    if page == "index":
        return page_arguments(layout)
    return page_arguments(layout) | available(layout) | {"missing": missing(layout)}


def page_files(layout: Layout) -> dict[str, Any]:
    """Files of a whole run's page."""
    settings, paths = layout.settings, layout.paths
    rows = pictured(layout)
    scenes = tables.unique(row["scene"] for row in rows)
    figures = default_figures(layout)
    shown = _reports(layout, default_tables(layout), figures) | soft_pictures.shown_files(
        layout, figures
    )
    return shown | {
        "claims_json": [paths.report("claims.json")] if settings["claims"] else [],
        "viewers": [paths.report(f"{name}.html") for name in settings["viewers"]],
        "references": tables.references(layout, scenes),
        "visibilities": tables.evaluations(layout, rows, "npz"),
        "metrics": tables.evaluations(layout, rows, "csv"),
        "meshes": [paths.scene("mesh.json", scene) for scene in shown_meshes(layout)],
        "trainings": tables.networks(layout, rows, "training.json"),
        "lpips_json": [paths.lpips],
    }


def _reports(layout: Layout, tables: Iterable[str], figures: Iterable[str]) -> dict[str, Any]:
    """The page's files of tables and figures."""
    report, endings = layout.paths.report, ("svg", "png")
    return {
        "tables": [report(f"{name}.json") for name in tables],
        "figures": [report(f"{name}.{ending}") for name in figures for ending in endings],
    }


def pictured(layout: Layout) -> list[tables.Row]:
    """Methods of default tables and claims, each once by scene."""
    rows = [
        *(row for claim in layout.settings["claims"].values() for row in claims.methods(claim)),
        *(r for name in default_tables(layout) for r in _rows_on_rays(layout, name)),
    ]
    # Of a method that is in several tables, the label of the last.
    # Ray tracing is the reference itself, and all dark shows nothing.
    unseen = (RAY_TRACED, "all_dark")
    shown = {(row["scene"], row["method"]): row for row in rows if row["method"] not in unseen}
    return list(shown.values())


def _rows_on_rays(layout: Layout, table: str) -> list[tables.Row]:
    """Rows of a table, without networks on frames of a learning curve."""
    rows = layout.entry("tables", table).get("rows", ())
    return [row for row in rows if "steps" not in row]


def page_arguments(layout: Layout) -> dict[str, Any]:
    """Arguments of `write_page` beside its files."""
    figures = layout.settings["figures"]
    return {
        "titles": {name: one["title"] for name, one in figures.items()},
        "soft_viewers": [
            name for name, one in layout.settings["viewers"].items() if "frame_set" in one
        ],
        "data": {name: one["table"] for name, one in figures.items() if "table" in one},
        "chapters": chapters(layout),
        "questions": questions(layout),
        "networks": [
            one["label"]
            for section in ("experiments", "networks_by_scene")
            for one in layout.settings[section].values()
            if "scene" not in one
        ],
        "soft_pictures": soft_pictures.shown(layout),
        "folded": [name for name, one in figures.items() if one["folded"]],
        "missing": [],
        "rows": pictured(layout),
        "kinds": {
            row["label"]: kind_of(row)
            for table in layout.settings["tables"]
            for row in _rows_on_rays(layout, table)
        },
        "run": layout.run(),
        "scenes": layout.scenes(layout.mesh_scenes),
        "benchmarks": layout.paths.benchmarks,
    }


def method_modules(layout: Layout) -> set[Path]:
    """The modules of the methods of all tables: the page shows their looks."""
    modules = (kinds.method_modules(layout, "tables", name) for name in layout.settings["tables"])
    return {path for paths in modules for path in paths}


def available(layout: Layout) -> dict[str, Any]:
    """Existing files of `page_files`, with reports on request."""
    files = page_files(layout) | _reports(layout, *map(layout.settings.get, ("tables", "figures")))
    return {name: [path for path in paths if Path(path).exists()] for name, paths in files.items()}


def missing(layout: Layout) -> list[str]:
    """Names of a whole run's reports, and frames of methods, that are not made yet."""
    names = {
        "json": [*default_tables(layout), *(["claims"] if layout.settings["claims"] else [])],
        "svg": default_figures(layout),
        "html": layout.settings["viewers"],
    }
    paths = {name: layout.paths.report(f"{name}.{end}") for end in names for name in names[end]}
    return [name for name, path in paths.items() if not Path(path).exists()] + [
        text for scene in layout.mesh_scenes for text in _missing_frames(layout, scene)
    ]


def _missing_frames(layout: Layout, scene: str) -> list[str]:
    """Count a rendered scene's methods with missing frames."""
    if not all(Path(path).exists() for path in tables.references(layout, [scene])):
        return []
    methods = [row for row in pictured(layout) if row["scene"] == scene]
    files = [tables.evaluations(layout, [row], "npz") for row in methods]
    count = sum(not all(Path(path).exists() for path in paths) for paths in files)
    return [f"frames of {count} of {len(methods)} methods on {scene}"] if count else []


def newest(layout: Layout, page: str) -> float:
    """Time of the newest file available to a page without inputs, in seconds."""
    if page == "index":
        return 0.0
    paths = [Path(path) for paths in available(layout).values() for path in paths]
    return max((path.stat().st_mtime for path in paths), default=0.0)


def chapters(layout: Layout) -> dict[str, str]:
    """The page's chapter of each table and figure, by name."""
    entries = [*layout.settings["tables"].items(), *layout.settings["figures"].items()]
    return {name: entry["chapter"] for name, entry in entries}


def questions(layout: Layout) -> list[dict[str, str]]:
    """Questions of the page's findings, each with its claim and figure."""
    return [
        {"claim": name, "question": claim["question"], "figure": claim["figure"] or ""}
        for name, claim in layout.settings["claims"].items()
        if claim["question"]
    ]
