"""Files and parameters of reports, by kind."""

from pathlib import Path
from types import ModuleType
from typing import Any

from neural_shadows.evaluation.method_names import hard_modules
from neural_shadows.evaluation.soft_registry import is_network, method_module
from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.settings.kinds import kinds

FOLDERS = {
    "tables": "reports/tables",
    "figures": "reports/figures",
    "claims": "reports/claims/kinds",
}


def kind_of(layout: Layout, section: str, name: str) -> ModuleType:
    """Module of an entry's kind."""
    return kinds(FOLDERS[section])[layout.entry(section, name)["kind"]]


def files(layout: Layout, section: str, name: str) -> dict[str, Any]:
    """Input files of an entry, by argument of its function."""
    return kind_of(layout, section, name).files(layout, name)


def table_files(layout: Layout, table: str) -> dict[str, Any]:
    """Input files of a table; `beside` are built with it, not read."""
    inputs = files(layout, "tables", table)
    figures = layout.entry("tables", table)["figures"]
    beside = [layout.paths.report(f"{name}.png") for name in figures]
    return inputs | {"beside": [*beside, *inputs.get("beside", ())]}


def table_labels(layout: Layout, table: str) -> dict[str, str]:
    """Labels of a table in Snakemake's report."""
    settings = layout.entry("tables", table)
    return {"table": settings["published"] or table, "title": settings["title"]}


def figure_labels(layout: Layout, figure: str) -> dict[str, str]:
    """Labels of a figure in Snakemake's report."""
    number = figure.removeprefix("figure_").replace("_", ".")
    return {"figure": number, "title": layout.entry("figures", figure)["title"]}


def params(layout: Layout, section: str, name: str) -> dict[str, Any]:
    """Arguments of an entry's function besides files."""
    title = layout.entry(section, name)["title"]
    return {"title": title, **kind_of(layout, section, name).params(layout, name)}


def encodings(layout: Layout, section: str, name: str) -> set[str]:
    """Kinds of networks with weights read by an entry."""
    kind = kind_of(layout, section, name)
    return kind.encodings(layout, name) if hasattr(kind, "encodings") else set()


def forms(layout: Layout, section: str, name: str) -> set[str]:
    """Forms of screen-space networks with convolutions counted by an entry."""
    kind = kind_of(layout, section, name)
    return kind.forms(layout, name) if hasattr(kind, "forms") else set()


def generators(layout: Layout, section: str, name: str) -> list[str]:
    """Generators of scenes used by an entry."""
    kind = kind_of(layout, section, name)
    return kind.generators(layout, name) if hasattr(kind, "generators") else []


def method_modules(layout: Layout, section: str, name: str) -> set[Path]:
    """Modules of methods without networks of an entry or its table.

    They are imported by name, and define labels and sizes.
    """
    entry = layout.entry(section, name)
    table = name if section == "tables" else entry.get("table")
    has_methods = "methods" in layout.settings["tables"].get(table, ())
    soft = soft_methods.methods(layout, table) if has_methods else ()
    hard = hard_modules(row["method"] for row in entry.get("rows", ()))
    return hard | {method_module(key) for key in soft if not is_network(key)}


def uses_gpu(layout: Layout, section: str, name: str) -> bool:
    """Check for possible GPU use by an entry's job."""
    return getattr(kind_of(layout, section, name), "USES_GPU", False)
