"""The files and parameters of `write_claims.claims`."""

from pathlib import Path
from typing import Any

from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.report_inputs import Report
from neural_shadows.reports.claims.claim_kinds import by_kind, kind_of, methods
from neural_shadows.reports.data.lights import light_sizes
from neural_shadows.settings.kinds import kinds

FILES = (
    *("metrics", "losses", "trainings", "times", "meshes"),
    *("soft_metrics", "soft_times", "tables", "screen_trainings"),
)


def files(layout: Layout) -> dict[str, Any]:
    """The files of all claims, each once."""
    paths = {name: [] for name in FILES}
    for claim in layout.settings["claims"].values():
        for name, claim_paths in kind_of(claim).files(layout, claim).items():
            paths[name] += claim_paths
    paths = {name: tables.unique(all_paths) for name, all_paths in paths.items()}
    return paths | {"published_csv": layout.source("config/published.csv")}


def arguments(layout: Layout) -> dict[str, Any]:
    """The parameters of `write_claims.claims` beside its files."""
    claims = layout.settings["claims"]
    rows = [row for claim in claims.values() for row in methods(claim)]
    soft_tables = {by_kind(claim, "soft_table", default=None) for claim in claims.values()}
    return {
        "claims": claims,
        "learning_curves": tables.curves(layout, rows),
        "soft_tables": {
            table: {
                "frame_set": tables.frame_set(layout, table),
                "labels": Report(layout, table, layout.entry("tables", table)).labels(),
                "scenes": tables.shown_scenes(layout, table),
                "lights": tables.lights(layout, table),
                "radii": light_sizes(layout.frames(tables.frame_set(layout, table))),
            }
            for table in sorted(soft_tables - {None})
        },
        "run": layout.run(),
        "scenes": layout.scenes(row["scene"] for row in rows),
    }


def modules(layout: Layout) -> list[Path]:
    """The modules of the claims' kinds, imported by name."""
    names = [claim["kind"] for claim in layout.settings["claims"].values()]
    return [Path(kinds("reports/claims/kinds")[name].__file__) for name in names]
