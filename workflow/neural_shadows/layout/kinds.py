"""Files and parameters of reports, by kind."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from neural_shadows.errors import InputError
from neural_shadows.evaluation import registry
from neural_shadows.layout import frame_sets, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.report_inputs import FILES, PARAMS, Report
from neural_shadows.running.bundles import argument_types, required
from neural_shadows.settings.base import not_among
from neural_shadows.settings.kinds import kinds

FOLDERS = {
    "tables": "reports/tables",
    "figures": "reports/figures",
    "claims": "reports/claims/kinds",
}
# What writes a table or figure takes, beside what its function names.
_ALWAYS = {"tables": ("title", "published", "run"), "figures": ("title", "run")}


def kind_of(layout: Layout, section: str, name: str) -> ModuleType:
    """Module of an entry's kind."""
    return kinds(FOLDERS[section])[layout.entry(section, name)["kind"]]


def files(layout: Layout, section: str, name: str) -> dict[str, Any]:
    """Input files of an entry, by argument of its function.

    Those of `report_inputs.FILES`, and the kind's own, of its `files(layout, name)`.

    Raises:
        InputError: an argument is neither a file nor a setting.
    """
    names, report = _named(layout, section, name), _report(layout, section, name)
    own, params = _own(layout, section, name, "files"), _own(layout, section, name, "params")
    known = {**own, **params, **FILES, **PARAMS, **report.settings}
    if section == "figures":
        known["heading"] = report.name
    for argument in required(_function(layout, section, name)):
        if argument not in known:
            kind = report.settings["kind"]
            raise InputError(
                f"{section}.{name}: argument {not_among(argument, known)}. Let `files` or `params` of "
                f"{FOLDERS[section]}/{kind}.py return it, or rename it"
            )
    shared = (key for key in names if key in FILES and key not in own | params)
    return own | {key: FILES[key](report) for key in shared}


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
    """Arguments of an entry's function besides files.

    Those of `report_inputs.PARAMS`, the entry's own settings by their keys, and those of the kind's
    `params(layout, name)`.
    """
    names, report = _named(layout, section, name), _report(layout, section, name)
    own = _own(layout, section, name, "params")
    others = own.keys() | FILES.keys() | _own(layout, section, name, "files").keys()
    # In one order in each run: Snakemake compares parameters as text.
    keys = sorted({*_ALWAYS[section], *names} - others)
    settings = {key: report.settings[key] for key in keys if key in report.settings}
    shared = {key: PARAMS[key](report) for key in keys if key in PARAMS}
    return settings | shared | own


def _own(layout: Layout, section: str, name: str, function: str) -> Any:
    """Files, parameters or modules that only an entry's kind has."""
    kind = kind_of(layout, section, name)
    return getattr(kind, function)(layout, name) if hasattr(kind, function) else {}


def _named(layout: Layout, section: str, name: str) -> list[str]:
    """Arguments of the function of an entry's kind."""
    return [*argument_types(_function(layout, section, name))]


def _function(layout: Layout, section: str, name: str) -> Callable[..., Any]:
    kind = kind_of(layout, section, name)
    return kind.table if section == "tables" else kind.draw


def _report(layout: Layout, section: str, name: str) -> Report:
    return Report(layout, name, layout.entry(section, name))


def modules(layout: Layout, section: str, name: str) -> set[Path]:
    """Modules imported by name for an entry.

    Of networks with weights read, of generators of scenes with meshes read, of `method_modules`, and
    of the kind's `modules(layout, name)`.
    """
    named, report = _named(layout, section, name), _report(layout, section, name)
    imported = method_modules(layout, section, name) | {*_own(layout, section, name, "modules")}
    if "weights" in named:
        imported |= layout.network_modules(report.experiments)
    if "soft_meshes" in named:
        imported |= frame_sets.generators(layout, report.frame_set)
    return imported


def method_modules(layout: Layout, section: str, name: str) -> set[Path]:
    """Modules of methods without networks of an entry or its table.

    They are imported by name, and define labels and sizes.
    """
    entry = layout.entry(section, name)
    table = name if section == "tables" else entry.get("table")
    has_methods = "methods" in layout.settings["tables"].get(table, ())
    soft = tables.methods(layout, table) if has_methods else ()
    return registry.method_modules([*soft, *(row["method"] for row in entry.get("rows", ()))])


def uses_gpu(layout: Layout, section: str, name: str) -> bool:
    """Check for possible GPU use by an entry's job."""
    return getattr(kind_of(layout, section, name), "USES_GPU", False)
