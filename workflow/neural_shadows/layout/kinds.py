"""What the kind of a table, figure or claim says of an entry: its files and its parameters."""

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
    """The module of an entry's kind."""
    return kinds(FOLDERS[section])[layout.entry(section, name)["kind"]]


def files(layout: Layout, section: str, name: str) -> dict[str, Any]:
    """The files that an entry is made of, by the arguments of its kind's function."""
    return kind_of(layout, section, name).files(layout, name)


def table_files(layout: Layout, table: str) -> dict[str, Any]:
    """The files that a table is made of, and what is made with it and not read (`beside`)."""
    made_of = files(layout, "tables", table)
    figures = layout.entry("tables", table)["figures"]
    beside = [layout.paths.report(f"{name}.png") for name in figures]
    return made_of | {"beside": [*beside, *made_of.get("beside", ())]}


def table_labels(layout: Layout, table: str) -> dict[str, str]:
    """What Snakemake's report lists of a table: its number in its text, and its title."""
    settings = layout.entry("tables", table)
    return {"table": settings["published"] or table, "title": settings["title"]}


def figure_labels(layout: Layout, figure: str) -> dict[str, str]:
    """What Snakemake's report lists of a figure."""
    number = figure.removeprefix("figure_").replace("_", ".")
    return {"figure": number, "title": layout.entry("figures", figure)["title"]}


def params(layout: Layout, section: str, name: str) -> dict[str, Any]:
    """What its kind's function takes beside its files."""
    title = layout.entry(section, name)["title"]
    return {"title": title, **kind_of(layout, section, name).params(layout, name)}


def encodings(layout: Layout, section: str, name: str) -> set[str]:
    """The kinds of the networks whose weights an entry reads."""
    kind = kind_of(layout, section, name)
    return kind.encodings(layout, name) if hasattr(kind, "encodings") else set()


def forms(layout: Layout, section: str, name: str) -> set[str]:
    """The forms of the networks of whole frames whose convolutions an entry counts."""
    kind = kind_of(layout, section, name)
    return kind.forms(layout, name) if hasattr(kind, "forms") else set()


def generators(layout: Layout, section: str, name: str) -> list[str]:
    """The generators of the scenes that an entry looks into."""
    kind = kind_of(layout, section, name)
    return kind.generators(layout, name) if hasattr(kind, "generators") else []


def method_modules(layout: Layout, section: str, name: str) -> set[Path]:
    """The modules of the methods without a network of an entry or its table.

    They are imported by name, and have their looks and sizes.
    """
    entry = layout.entry(section, name)
    table = name if section == "tables" else entry.get("table")
    has_methods = "methods" in layout.settings["tables"].get(table, ())
    soft = soft_methods.methods(layout, table) if has_methods else ()
    hard = hard_modules(row["method"] for row in entry.get("rows", ()))
    return hard | {method_module(key) for key in soft if not is_network(key)}


def uses_gpu(layout: Layout, section: str, name: str) -> bool:
    """Whether an entry's job may compute networks on a GPU."""
    return getattr(kind_of(layout, section, name), "USES_GPU", False)
