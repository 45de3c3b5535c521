"""Frame time, quality and size of networks over their width [4.4.1, table 4.6]."""

import datetime
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.evaluation.frame_times import read_frame_times
from neural_shadows.evaluation.memory import network_bytes, shadow_map_bytes
from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.metrics.intervals import mean_interval
from neural_shadows.reports.phrases import describe_times, describe_training
from neural_shadows.reports.published import printed, read_published
from neural_shadows.reports.tables.writing import interval_text, thesis_texts, write_twins
from neural_shadows.training.record import read_training

COLUMNS = ("frame_ms", "lpips", "size_kib")  # what the thesis prints, in its order


def performance_table(
    rows: Sequence[Mapping[str, str | None]],
    scenes: Sequence[str],
    times: Mapping[str, Mapping[str, Any]],
    metrics: Mapping[str, pd.DataFrame],
    sizes: Mapping[str, int],
    published_table: str | None,
    published: pd.DataFrame,
    seed: int,
) -> pd.DataFrame:
    """A row per method: median frame time with its quartiles, mean LPIPS, size of the method.

    Args:
        rows: `method`, `label` and `published` (the row's key there, None for the method's) of
            each row.
        scenes: the scene of each row.
        times: as `read_frame_times` gives them.
        metrics: as `read_metrics` gives them, by scene; a method that is not in them has no
            LPIPS.
        sizes: bytes of networks by the key of the method.

    Returns:
        Columns `method, scene, frame_ms, frame_ms_q1, frame_ms_q3, repeats, lpips, lpips_low,
        lpips_high, size_kib`, then `thesis_<column>` and `<column>_minus_thesis` of the three
        that the thesis prints. Times in ms, sizes in KiB; the order is that of `rows`.

    Raises:
        InputError: a method has no frame times.
    """
    records = []
    for row, scene in zip(rows, scenes, strict=True):
        method = row["method"]
        if method not in times[scene]["methods"]:
            raise InputError(
                f"frame times of {scene}: there are none of {method}: delete the file and run again"
            )
        milliseconds = np.array(times[scene]["methods"][method]["ms"])
        first, median, third = np.quantile(milliseconds, (0.25, 0.5, 0.75))
        values = metrics[scene].query("method == @method and metric == 'lpips'")["value"]
        lpips = mean_interval(values.to_numpy(), seed) if len(values) else (np.nan,) * 3
        if method in sizes:
            size = sizes[method]
        else:
            size = np.nan if method == RAY_TRACED else shadow_map_bytes(method)
        record = {
            "method": row["label"],
            "scene": scene,
            "frame_ms": median,
            "frame_ms_q1": first,
            "frame_ms_q3": third,
            "repeats": len(milliseconds),
            "lpips": lpips[0],
            "lpips_low": lpips[1],
            "lpips_high": lpips[2],
            "size_kib": size / 1024,
        }
        for column in COLUMNS:
            value = printed(published, published_table, row["published"] or method, column)
            record |= {
                f"thesis_{column}": value,
                f"{column}_minus_thesis": record[column] - value,
            }
        records.append(record)
    return pd.DataFrame(records)


def write_performance_table(
    times_jsons: Sequence[Path],
    metrics: Mapping[str, Sequence[Path]],
    weights: Mapping[str, Path],
    training_jsons: Sequence[Path],
    published_csv: Path,
    csv_path: Path,
    md_path: Path,
    *,
    title: str,
    number: str | None,
    rows: Sequence[Mapping[str, str | None]],
    scenes: Sequence[str],
    scale: str,
    seed: int,
) -> None:
    """Write a table of frame times as CSV and Markdown.

    Args:
        metrics: files of per-view metrics by scene.
        weights: weight files by the key of the method; their size is measured.

    Raises:
        InputError: a file is missing or cut short.
    """
    times = read_frame_times(times_jsons)
    frame = performance_table(
        rows,
        scenes,
        times,
        {scene: read_metrics(paths) for scene, paths in metrics.items()},
        {name: network_bytes(path) for name, path in weights.items()},
        number,
        read_published(published_csv),
        seed,
    ).assign(scale=scale)
    columns = {
        "method": frame["method"].tolist(),
        "frame ms ↓": [
            interval_text(*values, 1)
            for values in frame[["frame_ms", "frame_ms_q1", "frame_ms_q3"]].to_numpy()
        ],
        "thesis ms": thesis_texts(frame["thesis_frame_ms"], 1),
        "LPIPS ↓": [
            "" if np.isnan(values[0]) else interval_text(*values, 4)
            for values in frame[["lpips", "lpips_low", "lpips_high"]].to_numpy()
        ],
        "thesis LPIPS": thesis_texts(frame["thesis_lpips"], 4),
        "size KiB": thesis_texts(frame["size_kib"], 0),
        "thesis KiB": thesis_texts(frame["thesis_size_kib"], 0),
    }
    notes = [
        "Frame time: median [quartiles] of whole frames, primary visibility and shading "
        "included; LPIPS: mean over views [95 % bootstrap interval]; *thesis*: the number that "
        "the thesis prints, its times from another machine.",
        *(describe_times(values) for values in times.values()),
        "A shadow map is rendered whole in each frame and its size is 4 N² bytes; ray tracing "
        "sends a shadow ray from each pixel that faces the light.",
        f"Scale: {scale}; seed {seed}; made on {datetime.date.today().isoformat()}.",
        *(f"Network {describe_training(read_training(path))}." for path in training_jsons),
    ]
    if number:
        title += f" (table {number} of the thesis)"
    write_twins(frame, columns, csv_path, md_path, title=title, notes=notes)
