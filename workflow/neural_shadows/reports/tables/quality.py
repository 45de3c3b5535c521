"""Image quality of methods: means over views with their bootstrap intervals."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.metrics.intervals import mean_interval
from neural_shadows.reports.tables.writing import interval_text

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


def quality_table(
    metrics: pd.DataFrame, rows: Sequence[Mapping[str, Any]], seed: int
) -> pd.DataFrame:
    """A row per method: means over all views of a scene, and bootstrap intervals.

    Args:
        metrics: as `read_metrics` gives it. No LPIPS at all means that its trunk is not
            available; its columns are then empty.
        rows: `method` (its key in `metrics`) and `label` (its name in the table) of each row.
        seed: of the bootstrap.

    Returns:
        Columns `method` (the label), the metrics, `<metric>_low` and `<metric>_high` (95 %),
        `views`; in the order of `rows`. Shares and FLIP are in [0, 1], PSNR in dB.

    Raises:
        InputError: a method lacks a finite value of a view that others have.
    """
    wide = _values_by_view(metrics, [row["method"] for row in rows])
    records = []
    for row in rows:
        intervals = {
            metric: mean_interval(wide[row["method"], metric].to_numpy(), seed)
            if (row["method"], metric) in wide
            else (np.nan, np.nan, np.nan)
            for metric in METRICS
        }
        record = {"method": row["label"]}
        record |= {metric: mean for metric, (mean, _, _) in intervals.items()}
        for metric, (_, low, high) in intervals.items():
            record |= {f"{metric}_low": low, f"{metric}_high": high}
        records.append(record | {"views": len(wide)})
    return pd.DataFrame(records)


def _values_by_view(metrics: pd.DataFrame, methods: Sequence[str]) -> pd.DataFrame:
    """Values with a row per view and a column per (method, metric), none of them missing."""
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
    triples = table[[metric, f"{metric}_low", f"{metric}_high"]].to_numpy(float) * factor
    return [interval_text(*triple, decimals) for triple in triples]
