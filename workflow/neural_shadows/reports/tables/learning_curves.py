"""Errors of networks on rays by training samples, and their extrapolation [4.2, 4.3]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import curves as curves_of
from neural_shadows.layout.tables import evaluations, networks, unique, unshadowed, with_curves
from neural_shadows.metrics.power_law import Curve
from neural_shadows.metrics.registry import error_of, value_of
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.curve_lines import (
    COLUMNS,
    EXTRAPOLATED,
    MEASURED,
    curve_cells,
    metric_lines,
)
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.inputs import by_folder, read_by_folder
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.quality import values_by_view
from neural_shadows.reports.data.table import Column, Table
from neural_shadows.reports.data.trained import THESIS_SAMPLES, Row, Trained
from neural_shadows.sections.learning_curves import check_curves
from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.sections.rows import TableByScene
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.records import CurvePoint, Run, SceneInfo
from neural_shadows.training.loss_curve import read_loss

END = "at the thesis's samples"


class Settings(TableByScene):
    """Errors of networks on rays at each budget of `learning_curves`."""

    kind: Literal["learning_curves"] = Field(description="`learning_curves`")

    def experiments_allowed(self, config: Sections) -> list[str]:
        return [name for name in config.points if name in config.ray_experiments]

    def classic_allowed(self, row: RowSettings) -> list[str]:
        return []

    def check(self, config: Sections, key: str) -> None:
        check_curves(config.learning_curves, f"{key}.kind: {self.kind!r}")
        super().check(config, key)


def files(layout: Layout, table: str) -> dict[str, Any]:
    rows = layout.entry("tables", table)["rows"]
    rows = [*with_curves(layout, rows), *unshadowed(unique(row["scene"] for row in rows))]
    return {
        "metrics": evaluations(layout, rows, "csv"),
        "losses": networks(layout, rows, "loss.csv"),
        "trainings": networks(layout, rows, "training.json"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    return {"curves": curves_of(layout, layout.entry("tables", table)["rows"])}


def table(
    metrics: list[Path],
    losses: list[Path],
    trainings: list[Path],
    meshes: list[Path],
    lpips_json: Path,
    published_csv: Path,
    published: str | None,
    rows: Sequence[Row],
    curves: Mapping[str, Sequence[CurvePoint]],
    run: Run,
    scenes: Mapping[str, SceneInfo],
) -> Table:
    """Tabulate `curve_table`; its Markdown has a row for each method and metric.

    Args:
        metrics: also of `no_shadow`, and of all points of the learning curves.
        losses, trainings: of these points.
        curves: `experiment`, `seed` and `samples` of each point, by the rows' experiments.
    """
    lpips = read_json(lpips_json)
    values = {scene: read_view_metrics(paths) for scene, paths in by_folder(metrics).items()}
    data = Trained(
        metrics={
            name: values_by_view(part, part["method"].unique()) for name, part in values.items()
        },
        losses={name: read_loss(path) for name, [path] in by_folder(losses).items()},
        trainings=read_by_folder(trainings),
        meshes=read_by_folder(meshes),
        curves=curves,
        seed=run["seed"],
    )
    printed_numbers = read_published(published_csv)
    printed = printed_numbers.loc[[published]].droplevel("table").to_dict() if published else {}
    table = curve_table(rows, data, printed)
    notes = [
        "Mean ± standard deviation over seeds. Each budget is trained from the start, with its own "
        "whole schedule. Loss: mean of the last tenth of the steps. PSNR: of the mean squared error "
        "of all views and seeds.",
        "exponent: −d log error / d log samples, between the first two budgets and between the "
        "last two, of PSNR's squared error and of 1 − SSIM. A power law without offset has a "
        "constant exponent.",
        "largest, as predicted: by the power law m∞ + a N^−b fitted to all budgets but the largest "
        "[90 % interval over seeds, with and without m∞, for a mean of as many seeds]. In "
        "simulations of such laws, with three seeds that differ by 1 to 3 %, it covers the "
        "measurement in 89 to 91 % of cases. missed by: relative error of the prediction.",
        f"at the thesis's samples: extrapolated to {THESIS_SAMPLES:,} [90 %], on these views. This "
        "needs a largest budget within its predicted interval, within 10 % of the prediction, and of "
        "at least a thirtieth of these samples; otherwise the cell has the reason. *thesis*: printed, "
        "on its own views.",
        *_describe_steps(table),
        *(phrases.describe_scene(name, mesh, scenes[name]) for name, mesh in data.meshes.items()),
        phrases.describe_frames(run),
        phrases.describe_lpips(lpips),
    ]
    table = table.assign(scale=run["scale"], lpips_net=lpips["net"] if lpips["available"] else None)
    several = table["scene"].nunique() > 1
    columns = curve_cells(table, lambda samples: f"{short(samples / 1e6)} M samples", END, _printed)
    columns = {name: cells for name, cells in columns.items() if name != "scene" or several}
    columns["thesis"] = Column(columns["thesis"], printed_of=END)
    return Table(table, columns, notes, text_columns=3 if several else 2)


def curve_table(
    rows: Sequence[Row], data: Trained, printed: Mapping[tuple[str, str], float]
) -> pd.DataFrame:
    """Tabulate errors by method, metric and budget, the thesis's budget included.

    `printed` has the thesis's numbers by the row's `published` and the metric.

    Columns: `scene`, `method` (the label), `metric` (loss, lpips or flip, psnr, ssim), `kind`,
    `MEASURED` of a budget and `EXTRAPOLATED` of the thesis's, `samples`; of a budget `mean` over
    seeds, their standard deviation `spread` and the values `by_seed` with spaces between them, and
    `exponent`, the local one from the budget before; `predicted` with the ends of its 90 %
    interval: at the largest budget from the others, with the relative `error` of the prediction,
    and at the thesis's budget from all, unless it is `unlicensed`, for the reason given; `step`,
    how many times the largest budget that it was predicted from; `no_shadow`, what drawing no
    shadow gives; and `thesis`, the printed value.
    """
    records = []
    for row in rows:
        budgets = data.budgets([row])
        samples = np.array([budget.samples for budget in budgets])
        method = {"scene": row["scene"], "method": row["label"]}
        last = data.trainings[budgets[-1].runs[row["experiment"]][0]]
        losses = np.array([data.end_losses(row, budget) for budget in budgets])
        errors_and_null = {"loss": (losses, last["no_shadow_loss"])}
        for metric in (data.metric(row, "lpips"), "psnr", "ssim"):
            means = [data.errors(row, metric, budget).mean() for budget in budgets]
            null = data.metrics[row["scene"]][NO_SHADOW, metric]
            errors_and_null[metric] = np.array(means), error_of(metric, null).mean()
        for metric, (errors, null) in errors_and_null.items():
            curve = Curve(samples, errors)
            diverged = data.diverged(row, budgets)
            lines = metric_lines(metric, curve, THESIS_SAMPLES, data.seed, diverged)
            if data.meshes[row["scene"]]["thesis_mesh"]:
                lines[-1]["thesis"] = printed.get((row["published"], metric), np.nan)
            key = method | {"metric": metric, "no_shadow": value_of(metric, null)}
            records += [key | line for line in lines]
    return pd.DataFrame(records, columns=COLUMNS)


def _describe_steps(table: pd.DataFrame) -> list[str]:
    """Describe the steps of the hold-out and of the extrapolation; nothing without both."""
    steps = [table.loc[table["kind"] == kind, "step"].dropna() for kind in (MEASURED, EXTRAPOLATED)]
    if any(column.empty for column in steps):
        return []
    held_out, extrapolated = steps[0].min(), steps[1].max()
    return [
        f"The hold-out predicts {short(held_out)} times the samples, the extrapolation to the thesis's "
        f"{extrapolated:,.0f} times: no hold-out tests whether the curve bends in between."
    ]


def _printed(last: pd.Series, extrapolated: pd.Series, form: str) -> dict[str, str]:
    thesis = extrapolated["thesis"]
    return {"thesis": "" if np.isnan(thesis) else form.format(thesis)}
