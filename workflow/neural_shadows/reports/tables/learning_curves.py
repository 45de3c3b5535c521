"""What each budget of training reaches, and how far that can be carried on [4.2, 4.3]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import curves as curves_of
from neural_shadows.layout.tables import metrics as metrics_of
from neural_shadows.layout.tables import networks, unique, unshadowed, with_curves
from neural_shadows.metrics import power_law
from neural_shadows.metrics.error_scale import error_of, value_of
from neural_shadows.metrics.power_law import Curve
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.inputs import by_folder, read_meshes
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.quality import values_by_view
from neural_shadows.reports.data.table import Column, Table, number_cells, write_table
from neural_shadows.reports.data.trained import THESIS_SAMPLES, Row, Trained
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.sections.rows import TableByScene
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.records import CurvePoint, Run, SceneInfo
from neural_shadows.training.loss_curve import read_loss

# Headings, and decimals as the thesis prints them.
READING = {
    "loss": ("loss ↓", 4),
    "lpips": ("LPIPS ↓", 4),
    "flip": ("FLIP ↓", 4),
    "psnr": ("PSNR ↑", 2),
    "ssim": ("SSIM ↑", 4),
}
PREDICTED = ["predicted", "predicted_low", "predicted_high"]
COLUMNS = [
    *("scene", "method", "metric", "kind", "samples", "mean", "spread", "by_seed", "exponent"),
    *(*PREDICTED, "step", "error", "unlicensed", "no_shadow", "thesis"),
]
MEASURED, EXTRAPOLATED = "measured", "extrapolated"  # kinds of rows


class Settings(TableByScene):
    """What each budget of `learning_curves` reaches."""

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
    scenes = unique(row["scene"] for row in rows)
    rows = [*with_curves(layout, rows), *unshadowed(scenes)]
    return {
        "metrics": metrics_of(layout, rows),
        "losses": networks(layout, rows, "loss.csv"),
        "trainings": networks(layout, rows, "training.json"),
        "meshes": [layout.paths.scene("mesh.json", scene) for scene in scenes],
        "lpips_json": layout.paths.lpips,
        "published_csv": layout.source("config/published.csv"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    rows = settings["rows"]
    return {
        "published": settings["published"],
        "rows": rows,
        "curves": curves_of(layout, rows),
        "run": layout.run(),
        "scenes": layout.scenes(row["scene"] for row in rows),
    }


def table(
    *,
    metrics: list[Path],
    losses: list[Path],
    trainings: list[Path],
    meshes: list[Path],
    lpips_json: Path,
    published_csv: Path,
    title: str,
    published: str | None,
    rows: Sequence[Row],
    curves: Mapping[str, Sequence[CurvePoint]],
    run: Run,
    scenes: Mapping[str, SceneInfo],
) -> Table:
    """The table of `curve_table` as CSV; as Markdown a row for each method and metric.

    Args:
        metrics: also of `no_shadow`, and of all points of the learning curves.
        losses, trainings: of these points.
        curves: `experiment`, `seed` and `samples` of each point, by the rows' experiments.
    """
    lpips = read_json(lpips_json)
    read = {scene: read_metrics(paths) for scene, paths in by_folder(metrics).items()}
    data = Trained(
        metrics={
            name: values_by_view(part, part["method"].unique()) for name, part in read.items()
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
        "Mean ± standard deviation over seeds; each budget is trained from the start, with its own "
        "whole schedule. Loss: of the last tenth of the steps. PSNR: of the mean squared error of "
        "all views and seeds.",
        "exponent: −d log error / d log samples, between the first two budgets and between the "
        "last two; of PSNR's squared error and of 1 − SSIM. A power law without offset has one "
        "exponent.",
        "largest, as predicted: by the power law m∞ + a N^−b of all budgets but the largest [90 % "
        "interval over seeds and over having m∞ or not, for a mean of as many seeds]. In "
        "simulations of such laws, with three seeds that differ by 1 to 3 %, it holds what is "
        "measured in 89 to 91 % of cases. missed by: prediction over measurement, of the error.",
        f"at the thesis's samples: extrapolated to {THESIS_SAMPLES:,} [90 %], on these views, "
        "where the largest budget lies within its predicted interval and 10 % of it, and is at "
        "least a thirtieth of that; otherwise why not. *thesis*: what it prints, on its own views.",
        *_describe_steps(table),
        *(phrases.describe_scene(name, mesh, scenes[name]) for name, mesh in data.meshes.items()),
        phrases.describe_frames(run),
        phrases.describe_lpips(lpips),
        phrases.describe_run(run),
    ]
    table = table.assign(scale=run["scale"], lpips_net=lpips["net"] if lpips["available"] else None)
    several = table["scene"].nunique() > 1
    columns = _cells(table)
    columns = {name: cells for name, cells in columns.items() if name != "scene" or several}
    printed_of = "at the thesis's samples"
    columns["thesis"] = Column(columns["thesis"], printed_of=printed_of)
    texts = 3 if several else 2
    title = phrases.titled(title, published)
    return Table(title, table, columns, notes, text_columns=texts)


def curve_table(
    rows: Sequence[Row], data: Trained, printed: Mapping[tuple[str, str], float]
) -> pd.DataFrame:
    """A row for each method, metric and budget, and for the thesis's budget.

    `printed` has the thesis's numbers by the row's `published` and the metric.

    Columns: `scene`, `method` (the label), `metric` (loss, lpips or flip, psnr, ssim), `kind`,
    `MEASURED` of a budget and `EXTRAPOLATED` of the thesis's, `samples`; of a budget `mean` over
    seeds, their standard deviation `spread` and the values `by_seed` with spaces between them, and
    `exponent`, the local one from the budget before; `predicted` with the ends of its 90 %
    interval: at the largest budget from the others, with the relative `error` of the prediction,
    and at the thesis's budget from all, unless it is `unlicensed`, for the reason given; `step`,
    how many times the largest budget that it was predicted from; `no_shadow`, what drawing no
    shadow gives; and `thesis`, what that prints.
    """
    found = []
    for row in rows:
        budgets = data.budgets([row])
        samples = np.array([budget.samples for budget in budgets])
        of = {"scene": row["scene"], "method": row["label"]}
        last = data.trainings[budgets[-1].runs[row["experiment"]][0]]
        losses = np.array([data.end_losses(row, budget) for budget in budgets])
        of_metric = {"loss": (losses, last["no_shadow_loss"])}
        for metric in (data.metric(row, "lpips"), "psnr", "ssim"):
            means = [data.errors(row, metric, budget).mean() for budget in budgets]
            null = data.metrics[row["scene"]][NO_SHADOW, metric]
            of_metric[metric] = np.array(means), error_of(metric, null).mean()
        for metric, (errors, null) in of_metric.items():
            curve = Curve(samples, errors)
            lines = _of_metric(metric, curve, data.seed, data.died(row, budgets))
            if data.meshes[row["scene"]]["thesis_mesh"]:
                lines[-1]["thesis"] = printed.get((row["published"], metric), np.nan)
            given = of | {"metric": metric, "no_shadow": value_of(metric, null)}
            found += [given | line for line in lines]
    return pd.DataFrame(found, columns=COLUMNS)


def _of_metric(metric: str, curve: Curve, seed: int, died: bool) -> list[dict[str, Any]]:
    """A line for each budget of a curve of errors, and for the thesis's; `died`: a training did."""
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
    if held := power_law.hold_out(curve, seed) if power_law.can_hold_out(curve) else None:
        lines[-1] |= _prediction(metric, held.predicted, held.low, held.high)
        lines[-1] |= {"step": held.step, "error": held.error}
    allowed, why = power_law.licensed([curve], THESIS_SAMPLES, seed, died)
    step = THESIS_SAMPLES / curve.samples[-1]
    beyond = {"kind": EXTRAPOLATED, "samples": THESIS_SAMPLES, "step": step, "unlicensed": why}
    lines.append(beyond)
    if allowed:
        lines[-1] |= _prediction(metric, *power_law.extrapolate(curve, THESIS_SAMPLES, seed))
    return lines


def _prediction(metric: str, *errors: float) -> dict[str, float]:
    """A predicted error and the ends of its interval as values, the lower end first."""
    value, *ends = (value_of(metric, error) for error in errors)
    return dict(zip(PREDICTED, (value, *sorted(ends))))


def _describe_steps(table: pd.DataFrame) -> list[str]:
    """One sentence on how far is predicted, and how far that was tried; none of two budgets."""
    steps = [table.loc[table["kind"] == kind, "step"].dropna() for kind in (MEASURED, EXTRAPOLATED)]
    if any(some.empty for some in steps):
        return []
    tried, asked = steps[0].min(), steps[1].max()
    return [
        f"The hold-out tries a step of {short(tried)} times the samples, and that to the thesis's is "
        f"{asked:,.0f} times: no hold-out sees what bends in between."
    ]


def _cells(table: pd.DataFrame) -> dict[str, list[str]]:
    """The Markdown's cells by heading: a row for each method and metric."""
    budgets = sorted(table.loc[table["kind"] == MEASURED, "samples"].unique())
    lines = []
    for (scene, method, metric), part in table.groupby(["scene", "method", "metric"], sort=False):
        heading, decimals = READING[metric]
        form = f"{{:.{decimals}f}}"
        measured, beyond = by_kind(part)
        last = measured.iloc[-1]
        exponents = measured["exponent"].dropna()
        ends = exponents.iloc[[0, -1]] if len(exponents) else exponents
        reached = measured.set_index("samples").reindex(budgets)
        spreads = number_cells(reached["spread"], f" ± {form}")
        means = number_cells(reached["mean"], form)
        error = "" if np.isnan(last["error"]) else f"{100 * last['error']:+.1f} %"
        lines.append(
            {"scene": scene, "method": method, "metric": heading}
            | {f"{short(n / 1e6)} M samples": a + b for n, a, b in zip(budgets, means, spreads)}
            | {
                "exponent": " → ".join(f"{one:.2f}" for one in ends),
                "largest, as predicted": _interval(last, form),
                "missed by": error,
                "at the thesis's samples": beyond["unlicensed"] or _interval(beyond, form),
                "thesis": "" if np.isnan(beyond["thesis"]) else form.format(beyond["thesis"]),
                "no shadow": form.format(part["no_shadow"].iloc[0]),
            }
        )
    return {name: [line[name] for line in lines] for name in lines[0]}


def by_kind(part: pd.DataFrame) -> tuple[pd.DataFrame, pd.Series]:
    """The rows of a method and metric that are measured, and the one at the thesis's samples."""
    measured = part["kind"] == MEASURED
    return part[measured], part[~measured].iloc[0]


def _interval(line: pd.Series, form: str) -> str:
    value, low, high = line[PREDICTED].astype(float)
    if np.isnan(value):
        return ""
    ends = "" if np.isnan(low) else f" [{form}, {form}]".format(low, high)
    return form.format(value) + ends


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
