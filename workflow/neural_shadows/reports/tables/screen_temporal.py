"""Flicker of screen-space networks, with and without TAA (NSM, figures 5, 6)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import screen_tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.screen_rows import (
    ABOUT_NULLS,
    describe_trainings,
    learned_rows,
    nulls_in,
)
from neural_shadows.reports.data.table import Table, numbers, write_table
from neural_shadows.reports.data.width_notes import describe_widths
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import MethodsTable
from neural_shadows.settings.base import Name
from neural_shadows.settings.records import Run


class Settings(MethodsTable):
    """Flicker of methods on a frame set's sequences, with and without TAA."""

    kind: Literal["screen_temporal"] = Field(description="`screen_temporal`")
    methods: list[Name] = Field(
        min_length=1, description="as those of `soft_methods`, in the table's order"
    )

    def methods_shown(self) -> list[str]:
        return self.methods

    def needs_sequence(self) -> bool:
        return True


def files(layout: Layout, table: str) -> dict[str, Any]:
    measured = screen_tables.files(layout, table, layout.entry("tables", table)["methods"])
    return measured | {"frames_json": screen_tables.frames_json(layout, table)}


def params(layout: Layout, table: str) -> dict[str, Any]:
    methods = layout.entry("tables", table)["methods"]
    return {"labels": screen_tables.labels(layout, methods), "run": layout.run()}


def table(
    *,
    soft_metrics: list[Path],
    trainings: list[Path],
    frames_json: Path,
    widths_json: Path | None = None,
    title: str,
    labels: Mapping[str, str],
    run: Run,
) -> Table:
    """Tabulate flicker by method, with and without averaging two frames.

    CSV: those of `temporal_table`, and the scale.

    Args:
        widths_json: of `measure_widths`, for a note.
        soft_metrics: of each method on the frame set; trainings: training.json of the networks.
        frames_json: a part of its test frames.
        labels: by method, in the table's order.
    """
    about = read_json(frames_json)
    records = {path.parent.name: read_json(path) for path in trainings}
    whole = temporal_table(read_soft_metrics(soft_metrics), labels).assign(scale=run["scale"])
    table = learned_rows(whole)
    kinds = [name.removeprefix("e_") for name in table if name.startswith("e_")]
    columns = {
        "method": table["label"],
        **{f"E, {kind}": numbers(table[f"e_{kind}"], "{:.4f}") for kind in kinds},
        **{f"exact, {kind}": numbers(table[f"reference_{kind}"], "{:.4f}") for kind in kinds},
        "MSE × 10⁻⁴ in sequences": numbers(table["mse_sequence"], "{:.1f}", 1e4),
        "MSE × 10⁻⁴ at edges": numbers(table["mse_edge"], "{:.1f}", 1e4),
    }
    radius = about["radii"][len(about["radii"]) // 2]
    notes = [
        "E: mean of exp(3 |change|) − 1 along a point's motion over a sequence (3.4), by what moves "
        "in it. Exact: E of the exact shadow, which truly changes with a moving light. Blur lowers E, "
        "so the squared error stands beside it.",
        f"Sequences have a light of {radius:g} m. TAA: each frame averaged with the one before, at "
        "points seen in both. Edges: within 3 pixels of a point light's shadow edges, in "
        "test frames, of all lights.",
        ABOUT_NULLS,
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    return Table(title, whole, columns, notes)


def temporal_table(errors: pd.DataFrame, labels: Mapping[str, str]) -> pd.DataFrame:
    """Tabulate flicker by method or null predictor, without and with TAA.

    Columns: `method`, `label`, `null` (see `nulls_in`), `taa`; by what moves in a sequence `e_camera`, …, and
    `reference_camera`, …, of the exact shadow; `mse_sequence`, and `mse_edge` of test frames, NaN
    with TAA.
    """
    rows = []
    for method, label in (dict(labels) | nulls_in(errors)).items():
        own = errors[errors["method"] == method]
        for taa in (False, True):
            end = "_taa" if taa else ""
            row = {"method": method, "label": f"{label} + TAA" if taa else label, "taa": taa}
            row["null"] = None if method in labels else method
            row |= _by_kind(own, f"instability{end}", "e")
            row |= _by_kind(own, "instability_reference", "reference")
            row["mse_sequence"] = _mean(own, "mse_taa" if taa else "mse_sequence")
            row["mse_edge"] = float("nan") if taa else _mean(own, "mse_edge")
            rows.append(row)
    return pd.DataFrame(rows)


def _by_kind(errors: pd.DataFrame, metric: str, prefix: str) -> dict[str, float]:
    rows = errors[errors["metric"] == metric]
    kinds: Sequence[str] = rows["part"].str.rsplit("_", n=1).str[0]
    return {f"{prefix}_{kind}": value for kind, value in zip(kinds, rows["value"])}


def _mean(errors: pd.DataFrame, metric: str) -> float:
    return float(errors[errors["metric"] == metric]["value"].mean())


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
