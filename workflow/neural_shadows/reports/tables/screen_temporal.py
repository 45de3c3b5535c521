"""How much networks on frames flicker, and what calms them (Datta et al. 2022, figures 5 and 6)."""

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
    """How much methods flicker on a frame set's sequences, with and without TAA."""

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
    """Two rows for each method: as it is, and each frame averaged with the one before.

    CSV: those of `temporal_table`, and the scale.

    Args:
        widths_json: what `measure_widths` wrote of its test frames, for a note.
        soft_metrics: of each method on the frame set; trainings: training.json of the networks.
        frames_json: a part of its test frames.
        labels: what each method is called, in the table's order.
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
        "E: mean of exp(3 |change|) − 1 along a point's way over a sequence (3.4), with what moves "
        "in it; exact: that of the exact shadow, which a moving light changes truly. Blur lowers E: "
        "so the squared error stands beside it.",
        f"Sequences have a light of {radius:g} m. TAA: each frame averaged with the one before, where "
        "that shows the same point. Edges: within 3 pixels of those of a point light's shadow, in "
        "test frames, of all lights.",
        ABOUT_NULLS,
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    return Table(title, whole, columns, notes)


def temporal_table(found: pd.DataFrame, labels: Mapping[str, str]) -> pd.DataFrame:
    """A row for each method as it is and one with TAA, and for what learns nothing.

    Columns: `method`, `label`, `null` (see `nulls_in`), `taa`; by what moves in a sequence `e_camera`, …, and
    `reference_camera`, …, of the exact shadow; `mse_sequence`, and `mse_edge` of test frames, which
    a filter over time has none of.
    """
    rows = []
    for method, label in (dict(labels) | nulls_in(found)).items():
        mine = found[found["method"] == method]
        for taa in (False, True):
            end = "_taa" if taa else ""
            row = {"method": method, "label": f"{label} + TAA" if taa else label, "taa": taa}
            row["null"] = None if method in labels else method
            row |= _by_kind(mine, f"instability{end}", "e")
            row |= _by_kind(mine, "instability_reference", "reference")
            row["mse_sequence"] = _mean(mine, "mse_taa" if taa else "mse_sequence")
            row["mse_edge"] = float("nan") if taa else _mean(mine, "mse_edge")
            rows.append(row)
    return pd.DataFrame(rows)


def _by_kind(found: pd.DataFrame, metric: str, prefix: str) -> dict[str, float]:
    rows = found[found["metric"] == metric]
    kinds: Sequence[str] = rows["part"].str.rsplit("_", n=1).str[0]
    return {f"{prefix}_{kind}": value for kind, value in zip(kinds, rows["value"])}


def _mean(found: pd.DataFrame, metric: str) -> float:
    return float(found[found["metric"] == metric]["value"].mean())


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
