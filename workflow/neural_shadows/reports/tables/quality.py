"""Quality of methods, as means over views with bootstrap intervals, and their time and size."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.metrics.intervals import mean_interval
from neural_shadows.reports.inputs import by_folder, read_sizes
from neural_shadows.reports.tables.writing import interval_cells

METRICS = ("lpips", "psnr", "ssim", "flip", "shadow_error", "false_shadow", "light_leak")
QUARTILES = ("frame_ms_q1", "frame_ms", "frame_ms_q3")

# Markdown: heading, factor, decimals. The thesis prints LPIPS and SSIM with four, PSNR with two.
READING = {
    "lpips": ("LPIPS ↓", 1, 4),
    "psnr": ("PSNR ↑", 1, 2),
    "ssim": ("SSIM ↑", 1, 4),
    "flip": ("FLIP ↓", 1, 4),
    "shadow_error": ("shadow error % ↓", 100, 2),
    "false_shadow": ("false shadow % ↓", 100, 2),
    "light_leak": ("light leak % ↓", 100, 2),
}


def with_ends(metric: str) -> list[str]:
    """The columns of a metric: its mean and the ends of its interval."""
    return [metric, f"{metric}_low", f"{metric}_high"]


def quality_table(
    metrics: pd.DataFrame, rows: Sequence[Mapping[str, Any]], seed: int
) -> pd.DataFrame:
    """A row per method: means over all views of a scene, and bootstrap intervals.

    Columns `method` (the label), the metrics, `<metric>_low` and `<metric>_high` (95 %), `views`.
    Shares and FLIP are in [0, 1], PSNR in dB. Without LPIPS its columns are empty. `metrics` is as
    `read_metrics` gives it, `seed` of the bootstrap.

    Raises:
        InputError: a method lacks a finite value of a view that others have.
    """
    wide = values_by_view(metrics, [row["method"] for row in rows])
    records = []
    for row in rows:
        record = {"method": row["label"], "views": len(wide)}
        for metric, values in wide[row["method"]].items():
            record |= dict(zip(with_ends(metric), mean_interval(values.to_numpy(), seed)))
        records.append(record)
    ends = [end for metric in METRICS for end in with_ends(metric)[1:]]
    return pd.DataFrame(records, columns=["method", *METRICS, *ends, "views"])


def values_by_view(metrics: pd.DataFrame, methods: Sequence[str]) -> pd.DataFrame:
    """Values with a row per view and a column per (method, metric), none of them missing.

    Without LPIPS there are no columns of it.

    Raises:
        InputError: a method lacks a finite value of a view that others have.
    """
    metrics = metrics[metrics["method"].isin(methods)]
    names = [name for name in METRICS if name != "lpips" or metrics["metric"].eq(name).any()]
    wide = metrics.pivot(index=["view_set", "view"], columns=["method", "metric"], values="value")
    wide = wide.reindex(columns=pd.MultiIndex.from_product([methods, names]))
    gaps = ~np.isfinite(wide)
    if gaps.any(axis=None):
        method, metric = gaps.any().idxmax()
        view_set, view = gaps[method, metric].idxmax()
        raise InputError(
            f"{method} has no finite {metric} of {view_set} view {view}: delete its metrics and "
            "run again"
        )
    return wide


def timed_quality(
    times: Mapping[str, Mapping[str, Any]],
    metrics: Sequence[Path],
    weights: Sequence[Path],
    rows: Sequence[Mapping[str, Any]],
    seed: int,
) -> pd.DataFrame:
    """A row per method, those of a scene together; `times` by scene.

    Columns `scene`, `method` (the label), `QUARTILES`, `repeats`, `bytes`, and those of
    `quality_table`; NaN where a column does not apply: a ray-traced frame is the reference itself.
    """
    sizes, files = read_sizes(rows, weights), by_folder(metrics)
    parts = []
    for scene, timed in times.items():
        here = [row for row in rows if row["scene"] == scene]
        known = []
        for row in here:
            ms, size = timed["methods"][row["method"]]["ms"], sizes.get(row["method"], np.nan)
            quartiles = dict(zip(QUARTILES, np.quantile(ms, (0.25, 0.5, 0.75))))
            names = {"scene": scene, "method": row["label"]}
            known.append({**names, **quartiles, "repeats": len(ms), "bytes": size})
        measured = [row for row in here if row["method"] != RAY_TRACED]
        quality = quality_table(read_metrics(files[scene]), measured, seed)
        parts.append(pd.DataFrame(known).merge(quality, on="method", how="left"))
    return pd.concat(parts, ignore_index=True)


def context_columns(
    mesh: Mapping[str, Any], lpips: Mapping[str, Any], run: Mapping[str, Any], seed: int
) -> dict[str, Any]:
    """What every row of a table of quality says of where it comes from; seed: of the views."""
    size = {name: run[name] for name in ("scale", "width", "height")}
    network = lpips["net"] if lpips["available"] else None
    return {"mesh": mesh["name"], **size, "lpips_net": network, "seed": seed}


def quality_cells(table: pd.DataFrame, metric: str) -> list[str]:
    """The Markdown's cells of a metric: mean [low, high]."""
    _, factor, decimals = READING[metric]
    return interval_cells(table, with_ends(metric), decimals, factor)
