"""Errors by training budget, and their extrapolation [4.2, 4.3].

Of networks on rays by samples, of screen-space networks by training frames.
"""

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
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.curve_lines import (
    COLUMNS,
    EXTRAPOLATED,
    MEASURED,
    PREDICTED,
    by_kind,
    metric_lines,
)
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.frame_curves import FURTHER, frames_table
from neural_shadows.reports.data.inputs import by_folder, read_by_folder
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.quality import values_by_view
from neural_shadows.reports.data.table import Column, Table, number_cells
from neural_shadows.reports.data.trained import THESIS_SAMPLES, Row, Trained
from neural_shadows.sections.any_report import Chapter
from neural_shadows.sections.experiments import ScreenExperimentName
from neural_shadows.sections.row_settings import Rows, RowSettings
from neural_shadows.sections.rows import TableByScene
from neural_shadows.sections.scenes import MeshName
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among
from neural_shadows.settings.records import CurvePoint, Run, SceneInfo
from neural_shadows.training.loss_curve import read_loss


class Settings(TableByScene):
    """Errors at each budget of `learning_curves`."""

    rows: dict[MeshName, Rows] = Field({}, description="methods on rays, by scene")
    networks: list[ScreenExperimentName] = Field(
        [], description="experiments on frames, instead of `rows`"
    )
    kind: Literal["learning_curves"] = Field(description="`learning_curves`")

    def chapter_of(self) -> Chapter:
        return self.chapter or ("networks" if self.networks else self.own_chapter)

    def experiments_allowed(self, config: Sections) -> list[str]:
        return [name for name in config.points if name in config.ray_experiments]

    def classic_allowed(self, row: RowSettings) -> list[str]:
        return []

    def check(self, config: Sections, key: str) -> None:
        if not config.learning_curves:
            raise ValueError(f"{key}.kind: {self.kind!r} needs the section `learning_curves`")
        if bool(self.rows) == bool(self.networks):
            raise ValueError(f"{key}: needs `rows` or `networks`, and not both")
        curves = [name for name in config.points if name in config.screen_experiments]
        for name in self.networks:
            check_among(f"{key}.networks", name, curves)
        super().check(config, key)

    def resolved_rows(self, config: Sections) -> list[Row]:
        """Resolved rows; of a network on frames one for each number of steps."""
        return super().resolved_rows(config) + [
            {
                **{"method": name, "experiment": name, "trained": True, "steps": steps},
                "label": f"{config.label_of(name)}, {steps:,} steps",
                "scene": config.experiments[name].frame_set,
            }
            for name in self.networks
            for steps in unique(point["steps"] for point in config.points[name])
        ]


def files(layout: Layout, table: str) -> dict[str, Any]:
    entry = layout.entry("tables", table)
    rows = entry["rows"]
    if entry["networks"]:
        points = with_curves(layout, rows)[len(rows) :]
        none = dict.fromkeys(("metrics", "losses", "meshes", "lpips_json"), [])
        return none | {"trainings": networks(layout, points, "training.json")}
    rows = [*with_curves(layout, rows), *unshadowed(unique(row["scene"] for row in rows))]
    return {
        "metrics": evaluations(layout, rows, "csv"),
        "losses": networks(layout, rows, "loss.csv"),
        "trainings": networks(layout, rows, "training.json"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    entry = layout.entry("tables", table)
    no_scenes = {"scenes": {}} if entry["networks"] else {}
    return {"curves": curves_of(layout, entry["rows"])} | no_scenes


def table(
    metrics: list[Path],
    losses: list[Path],
    trainings: list[Path],
    meshes: list[Path],
    lpips_json: Path | None,
    published_csv: Path,
    published: str | None,
    rows: Sequence[Row],
    curves: Mapping[str, Sequence[CurvePoint]],
    run: Run,
    scenes: Mapping[str, SceneInfo],
) -> Table:
    """Tabulate `curve_table`; its Markdown has a row for each method and metric.

    Of networks on frames `frames_table`.

    Args:
        metrics: also of `no_shadow`, and of all points of the learning curves.
        losses, trainings: of these points; of networks on frames `trainings` alone.
        curves: `experiment`, `seed` and `samples` of each point, by the rows' experiments.
    """
    records = read_by_folder(trainings)
    if not metrics:
        return _of_frames(frames_table(rows, curves, records, run["seed"]))
    lpips = read_json(lpips_json)
    values = {scene: read_view_metrics(paths) for scene, paths in by_folder(metrics).items()}
    data = Trained(
        metrics={
            name: values_by_view(part, part["method"].unique()) for name, part in values.items()
        },
        losses={name: read_loss(path) for name, [path] in by_folder(losses).items()},
        trainings=records,
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
            diverged = data.diverged(row, budgets)
            lines = metric_lines(metric, curve, THESIS_SAMPLES, data.seed, diverged)
            if data.meshes[row["scene"]]["thesis_mesh"]:
                lines[-1]["thesis"] = printed.get((row["published"], metric), np.nan)
            key = method | {"metric": metric, "no_shadow": value_of(metric, null)}
            records += [key | line for line in lines]
    return pd.DataFrame(records, columns=COLUMNS)


def _of_frames(table: pd.DataFrame) -> Table:
    steps = table.loc[table["kind"] == MEASURED, "step"].dropna()
    notes = [
        "Squared error on the images of validation, the same for all trainings, by training frames, the "
        "first of each scene. Mean ± standard deviation over seeds. Each budget is trained from the "
        "start, with a schedule of its own.",
        "exponent: −d log error / d log frames, between the first two budgets and between the last two.",
        "largest, as predicted: by the power law m∞ + a N^−b fitted to all budgets but the largest "
        f"[90 % interval over seeds], {short(steps.min())} times the frames. missed by: relative error "
        "of the prediction."
        if len(steps)
        else "Three seeds or more and three budgets or more give predictions.",
        f"at {FURTHER} × the frames: extrapolated [90 %], if the largest budget is within its predicted "
        "interval and within 10 % of the prediction; otherwise the cell has the reason.",
        "base: of what the network filters, or of the light map as it is; no shadow: of 1 everywhere; on "
        "the same images. on training frames: at the largest budget, with the base's there in brackets. "
        "Where both ratios to the base agree nothing is overfitted.",
    ]
    return Table(table, _cells(table), notes, text_columns=2)


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
    on_frames = "base" in table
    if on_frames:
        headings = [f"{frames:,} frames" for frames in budgets]
        beyond = f"at {FURTHER} × the frames"
    else:
        headings = [f"{short(samples / 1e6)} M samples" for samples in budgets]
        beyond = "at the thesis's samples"
    lines = []
    for (scene, method, metric), part in table.groupby(["scene", "method", "metric"], sort=False):
        described = metrics_by_key()[metric]
        form = f"{{:.{described.digits}f}}"
        part = _scaled(part, described.factor)
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
            | {heading: a + b for heading, a, b in zip(headings, means, spreads)}
            | {
                "exponent": " → ".join(f"{exponent:.2f}" for exponent in ends),
                "largest, as predicted": _interval(last, form),
                "missed by": error,
                beyond: extrapolated["unlicensed"] or _interval(extrapolated, form),
            }
            | (_beside(last, form) if on_frames else _printed(extrapolated, form))
            | {"no shadow": form.format(part["no_shadow"].iloc[0])}
        )
    return {name: [line[name] for line in lines] for name in lines[0]}


def _scaled(part: pd.DataFrame, factor: float) -> pd.DataFrame:
    """Rows with values in a metric's unit."""
    if factor == 1:
        return part
    errors = ["mean", "spread", *PREDICTED, "no_shadow", "base", "train_mean", "train_base"]
    return part.assign(**{name: factor * part[name].astype(float) for name in errors})


def _beside(last: pd.Series, form: str) -> dict[str, str]:
    """Cells of the base, and of training frames."""
    base, train, train_base = number_cells(last[["base", "train_mean", "train_base"]], form)
    return {"on training frames": f"{train} ({train_base or '–'})", "base": base}


def _printed(extrapolated: pd.Series, form: str) -> dict[str, str]:
    thesis = extrapolated["thesis"]
    return {"thesis": "" if np.isnan(thesis) else form.format(thesis)}


def _interval(line: pd.Series, form: str) -> str:
    value, low, high = line[PREDICTED].astype(float)
    if np.isnan(value):
        return ""
    ends = "" if np.isnan(low) else f" [{form}, {form}]".format(low, high)
    return form.format(value) + ends
