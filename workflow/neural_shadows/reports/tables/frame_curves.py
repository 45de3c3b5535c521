"""Errors of screen-space networks by training frames, and their extrapolation."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import curves as curves_of
from neural_shadows.layout.tables import networks, unique, with_curves
from neural_shadows.metrics.power_law import Curve
from neural_shadows.reports.data.curve_lines import COLUMNS, MEASURED, curve_cells, metric_lines
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.inputs import read_by_folder
from neural_shadows.reports.data.table import Table, number_cells
from neural_shadows.reports.data.trained import Row
from neural_shadows.sections.any_report import AnyTable
from neural_shadows.sections.experiments import ScreenExperimentName
from neural_shadows.sections.learning_curves import check_curves
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among
from neural_shadows.settings.records import CurvePoint, Run, TrainingRecord

# Also the error of a network's base, and both on training frames.
FRAMES_COLUMNS = [*COLUMNS, "base", "train_mean", "train_base", "steps"]
FURTHER = 4  # times the frames of the largest budget, for an extrapolation


class Settings(AnyTable):
    """Errors of screen-space networks at each budget of `learning_curves`."""

    own_chapter = "networks"
    kind: Literal["frame_curves"] = Field(description="`frame_curves`")
    networks: list[ScreenExperimentName] = Field(min_length=1, description="experiments on frames")

    def check(self, config: Sections, key: str) -> None:
        check_curves(config.learning_curves, f"{key}.kind: {self.kind!r}")
        curves = [name for name in config.points if name in config.screen_experiments]
        for name in self.networks:
            check_among(f"{key}.networks", name, curves)

    def resolved_rows(self, config: Sections) -> list[Row]:
        """A row of each network for each number of steps."""
        return [
            {
                **{"method": name, "experiment": name, "trained": True, "steps": steps},
                "label": f"{config.label_of(name)}, {steps:,} steps",
                "scene": config.experiments[name].frame_set,
            }
            for name in self.networks
            for steps in unique(point["steps"] for point in config.points[name])
        ]

    def resolved(self, config: Sections) -> dict[str, Any]:
        return self.model_dump() | {"rows": self.resolved_rows(config)}


def files(layout: Layout, table: str) -> dict[str, Any]:
    rows = layout.entry("tables", table)["rows"]
    points = with_curves(layout, rows)[len(rows) :]
    return {"trainings": networks(layout, points, "training.json")}


def params(layout: Layout, table: str) -> dict[str, Any]:
    return {"curves": curves_of(layout, layout.entry("tables", table)["rows"])}


def table(
    trainings: list[Path],
    rows: Sequence[Row],
    curves: Mapping[str, Sequence[CurvePoint]],
    run: Run,
) -> Table:
    """Tabulate `frames_table`; its Markdown has a row for each network and number of steps.

    Args:
        trainings: of all points of the learning curves.
        curves: `experiment`, `seed`, `steps` and `samples` (frames) of each point, by experiment.
    """
    table = frames_table(rows, curves, read_by_folder(trainings), run["seed"])
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
    columns = curve_cells(
        table, lambda frames: f"{frames:,} frames", f"at {FURTHER} × the frames", _beside
    )
    return Table(table, columns, notes, text_columns=2)


def _beside(last: pd.Series, extrapolated: pd.Series, form: str) -> dict[str, str]:
    """Cells of the base, and of training frames."""
    base, train, train_base = number_cells(last[["base", "train_mean", "train_base"]], form)
    return {"on training frames": f"{train} ({train_base or '–'})", "base": base}


def frames_table(
    rows: Sequence[Row],
    curves: Mapping[str, Sequence[CurvePoint]],
    trainings: Mapping[str, TrainingRecord],
    seed: int,
) -> pd.DataFrame:
    """Tabulate squared errors of screen-space networks by training frames.

    Columns as of `curve_table`, `scene` the frame set, `samples` frames, on the fixed images of
    validation, mean over the lights of the training; `EXTRAPOLATED` to `FURTHER` times the largest
    budget. And `steps`, `base` (the error of the network's base there, of one without that of the
    light map; `no_shadow` is on the same images), and both on training frames of each budget,
    `train_mean` and `train_base`.
    """
    records = []
    for row in rows:
        points = [p for p in curves[row["experiment"]] if p["steps"] == row["steps"]]
        runs = {
            frames: [trainings[p["experiment"]] for p in points if p["samples"] == frames]
            for frames in unique(p["samples"] for p in points)
        }
        errors = [
            [_of_lights(run, run["validation_mse"]) for run in same] for same in runs.values()
        ]
        curve = Curve(np.array([*runs]), np.array(errors))
        diverged = any(run["died_at_step"] is not None for same in runs.values() for run in same)
        lines = metric_lines("mse", curve, FURTHER * max(runs), seed, diverged)
        for line, same in zip(lines, runs.values()):
            line["train_mean"] = np.mean([_of_lights(run, run["train_mse"]) for run in same])
            line["train_base"] = _null(same[0], "train_null_mse")
        last = same[-1]
        key = {
            "scene": row["scene"],
            "method": row["label"],
            "metric": "mse",
            "steps": row["steps"],
        }
        key["no_shadow"] = _of_lights(last, last["null_mse"]["no_shadow"])
        records += [key | {"base": _null(last, "null_mse")} | line for line in lines]
    return pd.DataFrame(records, columns=FRAMES_COLUMNS)


def _of_lights(record: TrainingRecord, errors: Sequence[float | None]) -> float:
    """Mean error over the lights of a training."""
    lights = record["training"]["lights"] or range(len(errors))
    return float(np.mean([errors[light] for light in lights], dtype=float))  # of None NaN


def _null(record: TrainingRecord, key: str) -> float:
    """Error of a network's base, of one without that of the light map; NaN without a map."""
    *_, name = ["no_shadow", *record[key]]
    return np.nan if name == "no_shadow" else _of_lights(record, record[key][name])
