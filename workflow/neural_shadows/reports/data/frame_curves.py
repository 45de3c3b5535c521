"""Learning curves of screen-space networks by training frames."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from neural_shadows.layout.tables import unique
from neural_shadows.metrics.power_law import Curve
from neural_shadows.reports.data.curve_lines import COLUMNS, metric_lines
from neural_shadows.reports.data.trained import Row
from neural_shadows.settings.records import CurvePoint, TrainingRecord

# Of screen-space networks also the error of their base, and both on training frames.
FRAMES_COLUMNS = [*COLUMNS, "base", "train_mean", "train_base", "steps"]
FURTHER = 4  # times the frames of the largest budget, for an extrapolation


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
