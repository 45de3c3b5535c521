"""Errors by training budget, and their extrapolation [4.2, 4.3]."""

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
from neural_shadows.layout.tables import metrics as metrics_of
from neural_shadows.layout.tables import networks, unique, unshadowed, with_curves
from neural_shadows.metrics import power_law
from neural_shadows.metrics.power_law import Curve
from neural_shadows.metrics.registry import error_of, value_of
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.inputs import by_folder, read_meshes
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.quality import values_by_view
from neural_shadows.reports.data.table import Column, Table, number_cells, run_table, with_ends
from neural_shadows.reports.data.trained import THESIS_SAMPLES, Row, Trained
from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.sections.rows import TableByScene
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.records import CurvePoint, Run, SceneInfo
from neural_shadows.training.loss_curve import read_loss

PREDICTED = with_ends("predicted")
COLUMNS = [
    *("scene", "method", "metric", "kind", "samples", "mean", "spread", "by_seed", "exponent"),
    *(*PREDICTED, "step", "error", "unlicensed", "no_shadow", "thesis"),
]
MEASURED, EXTRAPOLATED = "measured", "extrapolated"  # kinds of rows


class Settings(TableByScene):
    """Errors at each budget of `learning_curves`."""

    kind: Literal["learning_curves"] = Field(description="`learning_curves`")

    def experiments_allowed(self, config: Sections) -> list[str]:
        return config.learning_curves.experiments

    def classic_allowed(self, row: RowSettings) -> list[str]:
        return []

    def check(self, config: Sections, key: str) -> None:
        if config.learning_curves is None:
            raise ValueError(f"{key}.kind: {self.kind!r} needs the section `learning_curves`")
        super().check(config, key)


def files(layout: Layout, table: str) -> dict[str, Any]:
    rows = layout.entry("tables", table)["rows"]
    rows = [*with_curves(layout, rows), *unshadowed(unique(row["scene"] for row in rows))]
    return {
        "metrics": metrics_of(layout, rows),
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
        trainings={name: read_json(path) for name, [path] in by_folder(trainings).items()},
        meshes=read_meshes(meshes),
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
    columns = _cells(table)
    columns = {name: cells for name, cells in columns.items() if name != "scene" or several}
    printed_of = "at the thesis's samples"
    columns["thesis"] = Column(columns["thesis"], printed_of=printed_of)
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
            lines = _metric_lines(metric, curve, data.seed, data.diverged(row, budgets))
            if data.meshes[row["scene"]]["thesis_mesh"]:
                lines[-1]["thesis"] = printed.get((row["published"], metric), np.nan)
            key = method | {"metric": metric, "no_shadow": value_of(metric, null)}
            records += [key | line for line in lines]
    return pd.DataFrame(records, columns=COLUMNS)


def _metric_lines(metric: str, curve: Curve, seed: int, diverged: bool) -> list[dict[str, Any]]:
    """Tabulate a curve of errors by budget, and its extrapolation.

    `diverged`: one of its trainings did.
    """
    lines = []
    for count, errors in zip(curve.samples, curve.values):
        each = value_of(metric, errors)
        lines.append(
            {
                "kind": MEASURED,
                "samples": count,
                "mean": value_of(metric, errors.mean()),
                "spread": each.std(ddof=1) if len(each) > 1 else np.nan,
                "by_seed": " ".join(f"{value:.6g}" for value in each),
            }
        )
    for line, exponent in zip(lines[1:], power_law.local_exponents(curve)):
        line["exponent"] = exponent
    if power_law.can_hold_out(curve) and (held_out := power_law.hold_out(curve, seed)):
        lines[-1] |= _prediction(metric, held_out.predicted, held_out.low, held_out.high)
        lines[-1] |= {"step": held_out.step, "error": held_out.error}
    allowed, reason = power_law.licensed([curve], THESIS_SAMPLES, seed, diverged)
    step = THESIS_SAMPLES / curve.samples[-1]
    extrapolated = {
        "kind": EXTRAPOLATED,
        "samples": THESIS_SAMPLES,
        "step": step,
        "unlicensed": reason,
    }
    lines.append(extrapolated)
    if allowed:
        lines[-1] |= _prediction(metric, *power_law.extrapolate(curve, THESIS_SAMPLES, seed))
    return lines


def _prediction(metric: str, *errors: float) -> dict[str, float]:
    """A predicted error and the ends of its interval as values, the lower end first."""
    value, *ends = (value_of(metric, error) for error in errors)
    return dict(zip(PREDICTED, (value, *sorted(ends))))


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


def _cells(table: pd.DataFrame) -> dict[str, list[str]]:
    """Format the cells by heading: a row for each method and metric."""
    budgets = sorted(table.loc[table["kind"] == MEASURED, "samples"].unique())
    lines = []
    for (scene, method, metric), part in table.groupby(["scene", "method", "metric"], sort=False):
        described = metrics_by_key()[metric]
        form = f"{{:.{described.digits}f}}"
        measured, extrapolated = by_kind(part)
        last = measured.iloc[-1]
        exponents = measured["exponent"].dropna()
        ends = exponents.iloc[[0, -1]] if len(exponents) else exponents
        reached = measured.set_index("samples").reindex(budgets)
        spreads = number_cells(reached["spread"], f" ± {form}")
        means = number_cells(reached["mean"], form)
        error = "" if np.isnan(last["error"]) else f"{100 * last['error']:+.1f} %"
        lines.append(
            {"scene": scene, "method": method, "metric": described.heading}
            | {f"{short(n / 1e6)} M samples": a + b for n, a, b in zip(budgets, means, spreads)}
            | {
                "exponent": " → ".join(f"{exponent:.2f}" for exponent in ends),
                "largest, as predicted": _interval(last, form),
                "missed by": error,
                "at the thesis's samples": extrapolated["unlicensed"]
                or _interval(extrapolated, form),
                "thesis": ""
                if np.isnan(extrapolated["thesis"])
                else form.format(extrapolated["thesis"]),
                "no shadow": form.format(part["no_shadow"].iloc[0]),
            }
        )
    return {name: [line[name] for line in lines] for name in lines[0]}


def by_kind(part: pd.DataFrame) -> tuple[pd.DataFrame, pd.Series]:
    """Split a method's rows of a metric into measured and extrapolated."""
    measured = part["kind"] == MEASURED
    return part[measured], part[~measured].iloc[0]


def _interval(line: pd.Series, form: str) -> str:
    value, low, high = line[PREDICTED].astype(float)
    if np.isnan(value):
        return ""
    ends = "" if np.isnan(low) else f" [{form}, {form}]".format(low, high)
    return form.format(value) + ends


if "snakemake" in globals():
    run_table(snakemake, table)
