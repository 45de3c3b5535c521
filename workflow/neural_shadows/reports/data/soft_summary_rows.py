"""Means over frames and lights of soft-shadow methods, beside printed numbers."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.soft_registry import UNLEARNED
from neural_shadows.reports.data.frame_means import OFF_EDGES, by_frame, mean_with_interval
from neural_shadows.reports.data.published import printed_value
from neural_shadows.reports.data.soft_costs import cost
from neural_shadows.settings.records import Row, SoftTimes

MOVES = ("both", "camera", "light")  # what moves in a sequence; the first is the paper's


def summary_table(
    errors: pd.DataFrame,
    times: SoftTimes,
    radii: Sequence[float],
    *,
    methods: Sequence[Row],
    by: str | None,
    metrics: Sequence[str],
    measured: Sequence[str],
) -> pd.DataFrame:
    """Tabulate methods, for each scene or radius if `by` names one.

    Columns: `scene`, or `number` and `radius` of the light, where rows are by these; `method`, `label`;
    `null`, the method if it is a null predictor; of `metrics`: `mse` with
    `mse_off_edges`, and `ssim`, with the ends of their intervals, `time` (ms), those of `_in_sequences`.

    Args:
        errors: of `read_soft_metrics`; times: of `time_soft_methods`; radii: of the lights.
        methods, by, metrics, measured: as of `tables.soft_summary.table`.
    """
    frames = errors[errors["scene"].isin(measured)]
    return pd.DataFrame(
        [
            group | _row(group_frames, errors, times, row, metrics, len(radii))
            for group, group_frames in _groups(frames, by, measured, radii)
            for row in methods
        ]
    )


def _groups(
    frames: pd.DataFrame, by: str | None, scenes: Sequence[str], radii: Sequence[float]
) -> Iterator[tuple[dict[str, Any], pd.DataFrame]]:
    """Key columns and frames of each part of the table."""
    match by:
        case "scene":
            for scene in scenes:
                yield {"scene": scene}, frames[frames["scene"] == scene]
        case "radius":
            for number, radius in enumerate(radii):
                yield {"number": number, "radius": radius}, frames[frames["radius"] == number]
        case _:
            yield {}, frames


def _row(
    frames: pd.DataFrame,
    errors: pd.DataFrame,
    times: SoftTimes,
    row: Row,
    metrics: Sequence[str],
    radii: int,
) -> dict[str, Any]:
    """A method's row: `method`, `label` and `metrics`."""
    own = frames[frames["method"] == row["method"]]
    values: dict[str, Any] = {"method": row["method"], "label": row["label"]}
    values["null"] = row["method"] if row["method"] in UNLEARNED else None
    for metric in ("mse", "ssim"):
        if metric in metrics:
            values |= mean_with_interval(by_frame(own, metric), metric)
    if "mse" in metrics:
        values |= mean_with_interval(by_frame(own, OFF_EDGES), OFF_EDGES)
    if "time" in metrics:
        values["time"] = float(np.mean([cost(times, row["method"], k)["ms"] for k in range(radii)]))
    if "temporal_error" in metrics:
        values |= _in_sequences(errors[errors["method"] == row["method"]])
    return values


def _in_sequences(own: pd.DataFrame) -> dict[str, float]:
    """Temporal errors by mover, the exact shadow's, and the squared error."""
    moves = own["part"].str.rsplit("_", n=1).str[0]

    def mean(metric: str, mover: str) -> float:
        return float(own[(own["metric"] == metric) & (moves == mover)]["value"].mean())

    return {
        "temporal_error": mean("temporal_error", MOVES[0]),
        **{f"temporal_error_{mover}": mean("temporal_error", mover) for mover in MOVES[1:]},
        "temporal_error_reference": mean("temporal_error_reference", MOVES[0]),
        "mse_sequence": mean("mse_sequence", MOVES[0]),
    }


def with_printed(
    table: pd.DataFrame,
    metric: str,
    first: bool,
    published: str | None,
    methods: Sequence[Row],
    numbers: pd.Series,
) -> pd.DataFrame:
    """Add `printed_METRIC` and `METRIC_minus_printed`."""
    printed = [
        printed_value(numbers, published, row["published"], row["column"] or metric, metric)
        if first or not row["column"]
        else np.nan
        for row in methods
    ]
    table = table.assign(**{f"printed_{metric}": printed * (len(table) // len(methods))})
    return table.assign(**{f"{metric}_minus_printed": table[metric] - table[f"printed_{metric}"]})
