"""Comparison tables: means over views beside the numbers that the thesis prints [4.2, 4.3]."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from tabulate import tabulate

from neural_shadows.broken import broken, reading
from neural_shadows.csv_file import read_csv
from neural_shadows.errors import InputError
from neural_shadows.files import write_text
from neural_shadows.published import printed
from neural_shadows.statistics import mean_interval

PRINTED = ("lpips", "psnr", "ssim")  # what the thesis's tables give, in its order
METRICS = (*PRINTED, "flip", "shadow_error", "false_shadow", "light_leak")
CONTEXT = ("mesh", "scale", "width", "height", "lpips_net", "seed")

METRICS_DTYPES = {
    "view": "int64",
    "view_set": "str",
    "method": "str",
    "metric": "str",
    "value": "float64",
}

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


def read_metrics(paths: Iterable[str | Path]) -> pd.DataFrame:
    """Read and join per-view metrics: a row per view, view set, method and metric.

    Columns: `view` (int), `view_set`, `method`, `metric`, `value` (float, finite), and `file`,
    the path that the row came from.

    Raises:
        InputError: a file is missing, cut short or not one of metrics (it is then moved aside),
            or repeats what it or an earlier one holds.
    """
    metrics = pd.concat([_read_one(path) for path in paths], ignore_index=True)
    twice = metrics.duplicated(["view", "view_set", "method", "metric"])
    if twice.any():
        row = metrics[twice].iloc[0]
        raise InputError(
            f"{row['file']}: {row['metric']} of {row['method']} in {row['view_set']} view "
            f"{row['view']} was given before: delete the file and run again"
        )
    return metrics


def _read_one(path: str | Path) -> pd.DataFrame:
    with reading(path, "file of metrics"):
        metrics = read_csv(path, METRICS_DTYPES)
    if metrics.empty or metrics.isna().any(axis=None):
        raise broken(path, "metrics are cut short")
    if not np.isfinite(metrics["value"]).all():
        raise broken(path, "a value is not finite")
    return metrics.assign(file=str(path))


def comparison_table(
    metrics: pd.DataFrame,
    rows: Sequence[Mapping[str, str | None]],
    published_table: str | None,
    published: pd.DataFrame,
    context: Mapping[str, Any],
    seed: int,
) -> pd.DataFrame:
    """A row per method: means over all views, bootstrap intervals, the thesis's numbers.

    Args:
        metrics: as `read_metrics` gives it (`file` may be absent). No LPIPS at all means that
            its trunk could not be had; its columns are then empty.
        rows: `method` (its key in `metrics`), `label` (its name in the table) and `published`
            (its row in `published`, None where that is the method's key) of each row.
        published_table: the table of the thesis, "4.3"; None for one that is not in it.
        published: as `read_published` gives it.
        context: `mesh`, `scale`, `width`, `height` (pixels), `lpips_net` (None without LPIPS)
            and `seed` (of the viewpoints).
        seed: of the bootstrap.

    Returns:
        Columns `method, lpips, psnr, ssim`, then the other metrics, `<metric>_low` and
        `<metric>_high` (95 %), `views`, `thesis_<metric>` and `<metric>_minus_thesis` of the
        three that the thesis prints, then the context. Sorted by LPIPS as in the thesis, by
        FLIP without it. Shares and FLIP are in [0, 1], PSNR in dB.

    Raises:
        InputError: a method has no values of a metric, fewer views than the others, or a value
            that is not finite.
    """
    wide = _values_by_view(metrics, [row["method"] for row in rows])
    has_lpips = "lpips" in wide.columns.get_level_values("metric")

    records = []
    for row in rows:
        key = row["method"]
        intervals = {
            metric: mean_interval(wide[key, metric].to_numpy(), seed)
            if metric != "lpips" or has_lpips
            else (np.nan, np.nan, np.nan)
            for metric in METRICS
        }
        record = {"method": row["label"]}
        record |= {metric: mean for metric, (mean, _, _) in intervals.items()}
        for metric, (_, low, high) in intervals.items():
            record |= {f"{metric}_low": low, f"{metric}_high": high}
        record["views"] = len(wide)
        thesis = {
            metric: printed(published, published_table, row["published"] or key, metric)
            for metric in PRINTED
        }
        record |= {f"thesis_{metric}": value for metric, value in thesis.items()}
        record |= {
            f"{metric}_minus_thesis": record[metric] - value for metric, value in thesis.items()
        }
        records.append(record | {name: context[name] for name in CONTEXT})
    order = "lpips" if has_lpips else "flip"
    return pd.DataFrame(records).sort_values(order, kind="stable", ignore_index=True)


def _values_by_view(metrics: pd.DataFrame, keys: Sequence[str]) -> pd.DataFrame:
    """Values with a row per view and a column per (method, metric), none of them missing."""
    metrics = metrics[metrics["method"].isin(keys) & metrics["metric"].isin(METRICS)]
    bad = ~np.isfinite(metrics["value"])
    if bad.any():
        row = metrics[bad].iloc[0]
        raise InputError(
            f"{row['metric']} of method {row['method']} in {row['view_set']} view {row['view']} "
            f"is {row['value']}: delete {_source(metrics[bad])} and run again"
        )
    wide = metrics.pivot(index=["view_set", "view"], columns=["method", "metric"], values="value")
    has_lpips = metrics["metric"].eq("lpips").any()
    for key in keys:
        for metric in METRICS:
            if metric == "lpips" and not has_lpips:
                continue
            if (key, metric) not in wide:
                raise InputError(
                    f"method {key} has no values of {metric}: delete {_source(metrics)} "
                    "and run again, or take the method out of the table"
                )
            missing = wide.index[wide[key, metric].isna()]
            if len(missing):
                view_set, view = missing[0]
                beside = metrics["view_set"].eq(view_set) & metrics["view"].eq(view)
                raise InputError(
                    f"method {key} has {metric} of {len(wide) - len(missing)} views, others have "
                    f"{len(wide)} ({view_set} view {view} is missing): delete "
                    f"{_source(metrics[beside])} and run again"
                )
    return wide


def _source(metrics: pd.DataFrame) -> str:
    """The first file that the rows came from, and how many more."""
    if "file" not in metrics or metrics.empty:
        return "the metrics"
    first, *others = metrics["file"].unique()
    return f"{first} and {len(others)} more" if others else first


def write_table(
    frame: pd.DataFrame,
    csv_path: str | Path,
    md_path: str | Path,
    *,
    title: str,
    notes: Sequence[str],
) -> None:
    """Write a table of `comparison_table` as CSV and as a Markdown twin for reading.

    The Markdown is rounded, gives shares in per cent and the thesis's number beside ours, and
    ends with `notes` (scale, mesh, hardware, date, why LPIPS is missing), one a line.
    """
    columns = {"method": frame["method"].tolist()}
    for metric, (heading, factor, decimals) in READING.items():
        triples = frame[[metric, f"{metric}_low", f"{metric}_high"]].to_numpy(float) * factor
        columns[heading] = [interval_text(*triple, decimals) for triple in triples]
        if metric in PRINTED and frame[f"thesis_{metric}"].notna().any():
            columns[f"thesis {metric.upper()}"] = thesis_texts(frame[f"thesis_{metric}"], decimals)
    legend = (
        f"Mean over {frame['views'].iloc[0]} views [95 % bootstrap interval]; *thesis*: the "
        "number that the thesis prints."
    )
    write_twins(frame, columns, csv_path, md_path, title=title, notes=[legend, *notes])


def read_table(path: str | Path, texts: Sequence[str], numbers: Sequence[str]) -> pd.DataFrame:
    """Read the CSV of a table that `write_twins` wrote.

    Args:
        texts, numbers: columns that it must have; a cell may be empty, and is then NaN.

    Raises:
        InputError: the file is missing; or not whole or no such table, and moved aside.
    """
    kinds = dict.fromkeys(texts, "str") | dict.fromkeys(numbers, "float64")
    with reading(path, "table"):
        return read_csv(path, kinds, others=True)


def write_twins(
    frame: pd.DataFrame,
    columns: Mapping[str, Sequence[str]],
    csv_path: str | Path,
    md_path: str | Path,
    *,
    title: str,
    notes: Sequence[str],
    text_columns: int = 1,
) -> None:
    """Write a table as CSV (`frame`, all digits) and as its Markdown twin for reading.

    Args:
        columns: the Markdown's cells by heading.
        text_columns: how many columns from the left hold text; the others are aligned right.
        notes: one a line, below the table.
    """
    write_text(csv_path, frame.to_csv(index=False, float_format="%.6g"))
    table = tabulate(
        columns,
        headers="keys",
        tablefmt="pipe",
        disable_numparse=True,
        colalign=["left"] * text_columns + ["right"] * (len(columns) - text_columns),
    )
    items = "\n".join(f"- {note}" for note in notes)
    write_text(md_path, f"# {title}\n\n{table}\n\n{items}\n")


def thesis_texts(values: Iterable[float], decimals: int) -> list[str]:
    """Cells of printed numbers; empty where the thesis prints none."""
    return ["" if np.isnan(value) else f"{value:.{decimals}f}" for value in values]


def interval_text(value: float, low: float, high: float, decimals: int) -> str:
    """A cell: value [low, high], or `not available` for NaN."""
    if np.isnan(value):
        return "not available"
    return f"{value:.{decimals}f} [{low:.{decimals}f}, {high:.{decimals}f}]"
