"""The files and parameters of `write_claims.claims`."""

from pathlib import Path
from typing import Any

from neural_shadows.layout import soft_methods, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.claim_kinds import kind_of, methods
from neural_shadows.reports.claims.measured import Claim

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
    rows = [row for claim in layout.settings["claims"].values() for row in methods(claim)]
    return {
        "claims": layout.settings["claims"],
        "learning_curves": tables.curves(layout, rows),
        "soft_tables": {
            claim["table"]: {
                "frame_set": soft_methods.frame_set(layout, claim["table"]),
                "labels": soft_methods.labels(layout, claim["table"]),
                "scenes": soft_methods.shown_scenes(layout, claim["table"]),
                "radii": soft_methods.radii(layout, claim["table"]),
            }
            for claim in _claims_with(layout, "OF_SOFT_METHODS")
        },
        "run": layout.run(),
        "scenes": layout.scenes(row["scene"] for row in rows),
    }


def modules(layout: Layout) -> list[Path]:
    """The modules of the claims' kinds, imported by name."""
    return [Path(kind_of(claim).__file__) for claim in layout.settings["claims"].values()]


def counts_violations(layout: Layout, method: str) -> bool:
    """Check for a claim on a method's violated bounds."""
    rows = [row for claim in _claims_with(layout, "COUNTS_VIOLATIONS") for row in methods(claim)]
    return method in (row["method"] for row in tables.with_curves(layout, rows))


def _claims_with(layout: Layout, constant: str) -> list[Claim]:
    """The claims of kinds with a constant."""
    claims = layout.settings["claims"].values()
    return [claim for claim in claims if getattr(kind_of(claim), constant, False)]
