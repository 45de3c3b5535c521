"""Image quality of methods: means over views with their bootstrap intervals."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.metrics.intervals import mean_interval
from neural_shadows.reports.tables.writing import interval_cells

METRICS = ("lpips", "psnr", "ssim", "flip", "shadow_error", "false_shadow", "light_leak")

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
    Shares and FLIP are in [0, 1], PSNR in dB. Without LPIPS its columns are empty.

    Args:
        metrics: as `read_metrics` gives it; seed: of the bootstrap.

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


def context_columns(
    mesh: Mapping[str, Any], lpips: Mapping[str, Any], run: Mapping[str, Any], seed: int
) -> dict[str, Any]:
    """What every row of a table of quality says of where it comes from; seed: of the views."""
    return {
        "mesh": mesh["name"],
        "scale": run["scale"],
        "width": run["width"],
        "height": run["height"],
        "lpips_net": lpips["net"] if lpips["available"] else None,
        "seed": seed,
    }


def quality_cells(table: pd.DataFrame, metric: str) -> list[str]:
    """The Markdown's cells of a metric: mean [low, high]."""
    _, factor, decimals = READING[metric]
    return interval_cells(table, with_ends(metric), decimals, factor)
