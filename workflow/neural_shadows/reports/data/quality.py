"""Quality of methods on the same views, with intervals and paired differences."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.evaluation.registry import RAY_TRACED
from neural_shadows.metrics.intervals import mean_interval, pooled_psnr_interval
from neural_shadows.metrics.pooled_psnr import identical
from neural_shadows.metrics.registry import frame_metrics
from neural_shadows.reports.data.equivalent_maps import equivalent_maps
from neural_shadows.reports.data.inputs import by_folder
from neural_shadows.reports.data.learned import THESIS_METRICS, advantage, learned_methods
from neural_shadows.reports.data.table import with_ends
from neural_shadows.settings.records import Lpips, MeshReport, Row, Run

# The thesis's first.
METRICS = tuple(dict.fromkeys([*THESIS_METRICS, *frame_metrics("hard")]))


def scene_quality(
    metrics: Sequence[Path],
    rows: Sequence[Row],
    margins: Mapping[str, float],
    against: str | None,
    seed: int,
) -> pd.DataFrame:
    """Tabulate the quality of a scene's methods.

    Without ray tracing, the reference itself. Columns: those of `quality_table`, `learned`, those
    of `differences` and of `equivalent_maps`.

    Args:
        metrics: of all methods of the rows.
        margins: see `learned`.
        against: the method, among the rows, of paired differences.

    Raises:
        InputError: a file cannot be read, or a method lacks a value of a view that others have.
    """
    rows = [row for row in rows if row["method"] != RAY_TRACED]
    wide = values_by_view(read_view_metrics(metrics), [row["method"] for row in rows])
    table = quality_table(wide, rows, seed)
    learned = learned_methods(wide, rows, margins, seed)
    table["learned"] = pd.Series([learned.get(row["method"]) for row in rows], dtype=object)
    table = table.assign(**equivalent_maps(table, [row["method"] for row in rows]))
    return pd.concat([table, differences(wide, rows, against, seed)], axis=1)


def scenes_quality(
    metrics: Sequence[Path],
    rows: Sequence[Row],
    margins: Mapping[str, float],
    against: Mapping[str, str],
    seed: int,
) -> pd.DataFrame:
    """Tabulate `scene_quality` of all scenes, with `scene`; `against` by scene."""
    parts = []
    for scene, files in by_folder(metrics).items():
        of_scene = [row for row in rows if row["scene"] == scene]
        table = scene_quality(files, of_scene, margins, against.get(scene), seed)
        parts.append(table.assign(scene=scene))
    return pd.concat(parts, ignore_index=True)


def null_leaks(metrics: pd.DataFrame) -> pd.DataFrame:
    """Share of points in cast shadow by `view_set` and `view`.

    It is the light leak of no shadow.
    """
    leaks = metrics[metrics["method"].eq(NO_SHADOW) & metrics["metric"].eq("light_leak")]
    return leaks.set_index(["view_set", "view"])[["value"]]


def quality_table(wide: pd.DataFrame, rows: Sequence[Row], seed: int) -> pd.DataFrame:
    """Average each method over a scene's views, with bootstrap intervals.

    Columns `method` (the label), means of the metrics, `<metric>_low` and `<metric>_high` (95 %),
    `psnr_pooled` with its ends, `psnr_median`, `identical` (number of views equal to the reference),
    `views`. Shares and FLIP are in [0, 1], PSNR in dB. Without LPIPS its columns are empty.
    `wide`: of `values_by_view`; `seed`: of the bootstrap.
    """
    records = []
    for row in rows:
        record = {"method": row["label"], "views": len(wide)}
        for metric, values in wide[row["method"]].items():
            record |= dict(zip(with_ends(metric), mean_interval(values.to_numpy(), seed)))
        psnr = wide[row["method"], "psnr"].to_numpy()
        record |= dict(zip(with_ends("psnr_pooled"), pooled_psnr_interval(psnr, seed)))
        record |= {"psnr_median": np.median(psnr), "identical": identical(psnr)}
        records.append(record)
    ends = [end for metric in METRICS for end in with_ends(metric)[1:]]
    robust = [*with_ends("psnr_pooled"), "psnr_median", "identical"]
    return pd.DataFrame(records, columns=["method", *METRICS, *ends, *robust, "views"])


def differences(
    wide: pd.DataFrame, rows: Sequence[Row], against: str | None, seed: int
) -> pd.DataFrame:
    """Differences of methods from one of them on the same views.

    Columns `lpips_difference` (a mean) and `psnr_difference` (of pooled PSNRs, dB), the method's
    less the other's, with `_low` and `_high` (95 %); empty for the other itself or without one.
    """
    columns = [*with_ends("lpips_difference"), *with_ends("psnr_difference")]
    records = []
    for row in rows:
        record = dict.fromkeys(columns, np.nan)
        if against is not None and row["method"] != against:
            pair = wide[row["method"]], wide[against]
            if "lpips" in pair[0]:
                better, low, high = advantage(*(values["lpips"] for values in pair), "lpips", seed)
                record |= dict(zip(columns[:3], (-better, -high, -low)))
            difference = advantage(*(values["psnr"] for values in pair), "psnr", seed)
            record |= dict(zip(columns[3:], difference))
        records.append(record)
    return pd.DataFrame(records, columns=columns)


def values_by_view(metrics: pd.DataFrame, methods: Sequence[str]) -> pd.DataFrame:
    """Pivot values to a row per view and a column per (method, metric).

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


def context_columns(mesh: MeshReport, lpips: Lpips, run: Run, seed: int) -> dict[str, Any]:
    """Context of each row of a quality table; seed: of the views."""
    size = {name: run[name] for name in ("scale", "width", "height")}
    network = lpips["net"] if lpips["available"] else None
    return {"mesh": mesh["name"], **size, "lpips_net": network, "seed": seed}
