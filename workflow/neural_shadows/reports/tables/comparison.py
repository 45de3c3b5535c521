"""Comparison tables: means over views beside the numbers that the thesis prints [4.2, 4.3]."""

import datetime
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.evaluation.depth_biases import biases_by_method
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.metrics.intervals import mean_interval
from neural_shadows.metrics.lpips_choice import read_lpips_choice
from neural_shadows.reports.phrases import REFERENCES, describe_mesh, describe_training
from neural_shadows.reports.published import printed, read_published
from neural_shadows.reports.tables.writing import interval_text, thesis_texts, write_twins
from neural_shadows.training.record import read_training

PRINTED = ("lpips", "psnr", "ssim")  # what the thesis's tables give, in its order
METRICS = (*PRINTED, "flip", "shadow_error", "false_shadow", "light_leak")
CONTEXT = ("mesh", "scale", "width", "height", "lpips_net", "seed")

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


def write_table_report(
    metrics: Sequence[Path],
    mesh_json: Path,
    training_jsons: Sequence[Path],
    bias_jsons: Sequence[Path],
    lpips_json: Path,
    published_csv: Path,
    csv_path: Path,
    md_path: Path,
    *,
    title: str,
    number: str | None,
    rows: Sequence[Mapping[str, str | None]],
    scale: str,
    width: int,
    height: int,
    reference: str,
    procedural: bool,
    seed: int,
) -> None:
    """Write a comparison table as CSV and Markdown, with what a reader must know below it.

    Args:
        bias_jsons: depth biases that were found for methods of the table.
        number: the thesis's number of the table, "4.3"; None for one that is not in it.
        rows: see `comparison_table`.
        width, height: of the frames, in pixels.
        reference: `exact` or `shadow_map`.
        procedural: whether the pipeline made the mesh itself.

    Raises:
        InputError: metrics are missing, cut short or not finite.
    """
    mesh, lpips = read_mesh_report(mesh_json), read_lpips_choice(lpips_json)
    records = [read_training(path) for path in training_jsons]
    frame = comparison_table(
        read_metrics(metrics),
        rows,
        number,
        read_published(published_csv),
        {
            "mesh": mesh["name"],
            "scale": scale,
            "width": width,
            "height": height,
            "lpips_net": lpips["net"] if lpips["available"] else None,
            "seed": seed,
        },
        seed,
    )
    notes = [
        f"Scale: {scale}; frames of {width} × {height}; seed {seed}; "
        f"made on {datetime.date.today().isoformat()}.",
        f"Mesh: {describe_mesh(mesh, procedural)}.",
        f"Reference: {REFERENCES[reference]}.",
        *(f"Network {describe_training(record)}." for record in records),
    ]
    biases = biases_by_method(bias_jsons)
    notes += [
        f"{row['label']}: with a depth bias of {biases[row['method']]:g} sphere radii, its best on "
        "held-out views; the thesis's network has none, and maps their slope-scaled one."
        for row in rows
        if row["method"] in biases
    ]
    if lpips["available"]:
        notes.append(
            f"LPIPS's network is `{lpips['net']}`; the thesis does not say which it used, and "
            "values of different networks do not compare."
        )
    else:
        notes.append(
            f"LPIPS is missing, the rows are sorted by FLIP: {lpips['reason']}. After that, "
            "`--forcerun find_lpips` looks again."
        )
    if number:
        title += f" (table {number} of the thesis)"
    write_table(frame, csv_path, md_path, title=title, notes=notes)
