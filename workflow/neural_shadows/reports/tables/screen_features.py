"""Errors of screen-space networks by their features (NSM, table S1)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.frames.feature_names import FEATURES
from neural_shadows.layout import screen_tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.frame_means import (
    OFF_EDGES,
    by_frame,
    describe_units,
    mean_with_interval,
)
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.screen_rows import (
    ABOUT_NULLS,
    describe_trainings,
    learned_rows,
    nulls_in,
    with_printed,
)
from neural_shadows.reports.data.table import Table, filled, intervals, numbers, write_table
from neural_shadows.reports.data.width_notes import describe_widths
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import FramesTable
from neural_shadows.settings.base import Name, name_in
from neural_shadows.settings.records import Run

LEAST_SHARE = 0.015  # of sensitivity, of the paper's features (3.2)


class Settings(FramesTable):
    """Trained networks by sets of features."""

    published: str | None = Field(
        None, pattern=r"^nsm\.s1$", description="`nsm.` and the paper's number of this table"
    )
    kind: Literal["screen_features"] = Field(description="`screen_features`")
    columns: dict[Name, name_in("screen_experiments")] = Field(
        min_length=1, description="a name in `screen_experiments` for each of the paper's names"
    )

    def methods_shown(self) -> list[str]:
        return [*self.columns.values()]


def files(layout: Layout, table: str) -> dict[str, Any]:
    methods = layout.entry("tables", table)["columns"].values()
    measured = screen_tables.files(layout, table, methods)
    return measured | {
        "sensitivities": screen_tables.sensitivities(layout, table, methods),
        "published_nsm_csv": layout.source("config/published_nsm.csv"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    return {
        **{key: settings[key] for key in ("published", "columns")},
        "labels": screen_tables.labels(layout, settings["columns"].values()),
        "run": layout.run(),
    }


def table(
    *,
    soft_metrics: list[Path],
    trainings: list[Path],
    sensitivities: list[Path],
    published_nsm_csv: Path,
    widths_json: Path | None = None,
    title: str,
    published: str | None,
    columns: Mapping[str, str],
    labels: Mapping[str, str],
    run: Run,
) -> Table:
    """Tabulate error and sensitivities by set of features.

    CSV: those of `features_table`, printed errors and differences, and the scale.

    Args:
        widths_json: of `measure_widths`, for a note.
        soft_metrics: of each network on the frame set; trainings: training.json of each.
        sensitivities: of `measure_sensitivity`, of each.
        published: the paper's number of the table.
        columns: the experiment of each printed row; labels: by experiment.
    """
    records = {path.parent.name: read_json(path) for path in trainings}
    shares = {path.stem: read_json(path)["features"] for path in sensitivities}
    errors = read_soft_metrics(soft_metrics)
    table = features_table(errors, columns, labels, shares)
    # The paper gives two of these in its text (3.2) and the others in table S1.
    printed_numbers = read_published(published_nsm_csv).rename(
        index={"nsm.features": "nsm.s1"}, level=0
    )
    whole = with_printed(table, published, "error", "error", printed_numbers).assign(
        scale=run["scale"]
    )
    table = learned_rows(whole)
    frames = by_frame(errors[errors["method"].isin(columns.values())], "mse")
    sensitivity = [
        ", ".join(f"{name} {100 * part['share']:.1f}" for name, part in _sorted(shares[experiment]))
        for experiment in table["experiment"]
    ]
    cells = {
        "features": table["label"],
        "channels": numbers(table["channels"], "{:.0f}"),
        "MSE × 10⁻³": intervals(table, ["error", "error_low", "error_high"], 2, 1e3),
        "off edges × 10⁻³": numbers(table["error_off_edges"], "{:.2f}", 1e3),
        "printed × 10⁻³": numbers(table["printed_error"], "{:.2f}", 1e3),
        "difference": numbers(table["error_minus_printed"], "{:+.2f}", 1e3),
        "sensitivity, %": sensitivity,
    }
    notes = [
        "Mean over test frames and all lights, a point among them "
        f"[{describe_units([*frames.index.unique('scene')], len(frames))}]; the paper does not name its "
        "error; its numbers fit a squared one.",
        "Sensitivity: mean absolute change of the output with noise of a tenth of a feature's standard "
        "deviation, as a share of all features'. The paper drops features with less than "
        f"{100 * LEAST_SHARE:g} %.",
        ABOUT_NULLS,
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    cells = filled(cells)
    return Table(phrases.titled(title, published), whole, cells, notes)


def features_table(
    errors: pd.DataFrame,
    columns: Mapping[str, str],
    labels: Mapping[str, str],
    shares: Mapping[str, Mapping[str, Any]],
) -> pd.DataFrame:
    """Tabulate errors and sensitivities by network, with null predictors.

    Columns: `row`, the paper's; `null` (see `nulls_in`); `experiment`, `label`, `channels`, `error`
    and `error_off_edges` with the ends of their intervals, `share_NAME` of each feature, and `as_printed_NAME`.
    """
    rows = []
    for row, experiment in columns.items():
        parts = shares[experiment]
        rows.append(
            {"row": row, "null": None, "experiment": experiment, "label": labels[experiment]}
            | {"channels": sum(FEATURES[name] for name in parts)}
            | _errors(errors, experiment)
            | {f"share_{name}": part["share"] for name, part in parts.items()}
            | {f"as_printed_{name}": part["as_printed"] for name, part in parts.items()}
        )
    for null, label in nulls_in(errors).items():
        named = {"row": null, "null": null, "experiment": null, "label": label}
        rows.append(named | _errors(errors, null))
    return pd.DataFrame(rows)


def _errors(errors: pd.DataFrame, method: str) -> dict[str, float]:
    own = errors[errors["method"] == method]
    means = mean_with_interval(by_frame(own, "mse"), "error")
    return means | mean_with_interval(by_frame(own, OFF_EDGES), "error_off_edges")


def _sorted(features: Mapping[str, Any]) -> list[tuple[str, Any]]:
    return sorted(features.items(), key=lambda item: -item[1]["share"])


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
