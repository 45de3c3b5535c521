"""Methods for soft shadows over all lights, beside printed numbers.

Hu et al. 2025, tables 1 to 4, figures 7 and 9.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field, model_validator

from neural_shadows.evaluation.registry import UNLEARNED
from neural_shadows.files.whole_files import read_json
from neural_shadows.frames.uses import use_of
from neural_shadows.layout import frame_methods, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.registry import frame_metrics, metric_in
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.frame_means import (
    ABOUT_EDGES,
    OFF_EDGES,
    by_frame,
    describe_units,
    mean_with_interval,
)
from neural_shadows.reports.data.lights import light_name
from neural_shadows.reports.data.published import printed_value, read_published, with_printed
from neural_shadows.reports.data.quality_cells import metric_column
from neural_shadows.reports.data.soft_costs import cost, describe_times
from neural_shadows.reports.data.soft_frames import SoftFrames, describe_trainings
from neural_shadows.reports.data.table import Column, Table, filled, numbers
from neural_shadows.sections.frame_tables import MethodsTable, OfScenes
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Model, Name, Text, section_or
from neural_shadows.settings.records import SoftTimes

DIGITS = {"mse": 2, OFF_EDGES: 2, "ssim": 3}  # as the paper prints them


MOVES = ("both", "camera", "light")  # what moves in a sequence; the first is the paper's


class SummaryRow(Model):
    """A row of a summary with its own settings."""

    method: Name = Field(description="as those of `soft_methods`")
    label: Text | None = Field(None, description="without it the method's own label")
    published: Name | None = Field(None, description="its row in published_kpnsm.csv")
    column: Name | None = Field(
        None,
        description="its column there, of the first metric; without it columns have the metrics' names",
    )


class Settings(MethodsTable):
    """Methods for soft shadows over all lights together, beside printed numbers."""

    kind: Literal["soft_summary"] = Field(description="`soft_summary`")
    published: str | None = Field(
        None, pattern=r"^kpnsm\.[1-4]$", description="`kpnsm.` and the paper's number of this table"
    )
    methods: list[section_or(SummaryRow, "method")] = Field(
        min_length=1, description="in the table's order"
    )
    over: OfScenes = "trained"
    by: Literal["scene", "radius"] | None = Field(
        None, description="a part of the table for each; without it one row a method"
    )
    lights: list[Annotated[int, Field(ge=0)]] | None = Field(
        None,
        min_length=1,
        description="numbers of the frame set's radii, from 0, that count; by default all",
    )
    metrics: list[metric_in("soft", "time", "temporal_error")] = Field(
        ["mse", "ssim"],
        min_length=1,
        description="`temporal_error` is of the sequences of these scenes",
    )

    @model_validator(mode="after")
    def _check_metrics(self):
        if self.by and (wrong := {"time", "temporal_error"} & set(self.metrics)):
            raise ValueError(f"metrics: {min(wrong)} is not available with `by: {self.by}`")
        return self

    def methods_shown(self) -> list[str]:
        return [row.method for row in self.methods]

    def needs_sequence(self) -> bool:
        return "temporal_error" in self.metrics

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        if self.over == "unseen" and not getattr(config.frame_sets[self.frame_set], "unseen", ()):
            raise ValueError(f"{key}.over: frame_sets.{self.frame_set} has no `unseen`")
        radii = getattr(config.frame_sets[self.frame_set], "radii", None)  # none of a user's arrays
        beyond = [] if radii is None else [n for n in self.lights or () if n >= len(radii)]
        if beyond:
            raise ValueError(
                f"{key}.lights: {beyond[0]} is not below {len(radii)}, the number of radii of "
                f"{self.frame_set!r}"
            )


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    available = tables.methods(layout, table)
    labelled = [
        row | {"label": row["label"] or frame_methods.label(layout, row["method"])}
        for row in settings["methods"]
        if row["method"] in available
    ]
    return {
        "metrics": settings["metrics"],  # and no files of hard shadows
        "methods": labelled,
        "measured": tables.shown_scenes(layout, table),
    }


def table(
    soft: SoftFrames,
    soft_times: Path | None,
    published_kpnsm_csv: Path,
    published: str | None,
    methods: Sequence[Mapping[str, Any]],
    by: str | None,
    metrics: Sequence[str],
    measured: Sequence[str],
    lights: Sequence[int] | None,
) -> Table:
    """Tabulate methods, for each scene or radius if `by` names one.

    CSV: those of `summary_table`, printed numbers and differences, the radii's unit, and the scale.

    Args:
        soft_times: of `time_methods`; None where `metrics` has no time.
        published: `kpnsm.` and the paper's number of the table; None without printed numbers.
        by: `scene`, `radius`, or None; metrics: of `Settings`.
        measured: the scenes whose frames count; lights: the numbers of the radii that do, None for all.
    """
    lights = lights or range(len(soft.radii))
    times = read_json(soft_times) if soft_times else {"methods": {}}
    printed_numbers = read_published(published_kpnsm_csv)
    table = summary_table(soft, times, methods, by, metrics, measured, lights)
    for metric in metrics:
        first = metric == metrics[0]  # the metric of `column`
        printed = [
            printed_value(
                printed_numbers, published, row["published"], row["column"] or metric, metric
            )
            if first or not row["column"]
            else np.nan
            for row in methods
        ]
        table = with_printed(table, metric, printed * (len(table) // len(methods)))
    table = table.assign(unit=soft.unit)
    notes = [
        *_describe_frames(soft, metrics, measured, lights, by),
        *soft.describe_widths(measured),
        *([_describe_sequences(soft.errors, measured)] if "temporal_error" in metrics else []),
        *([_describe_printed(metrics)] if published else []),
        *describe_times(times),
        *describe_trainings(soft.records, {row["method"]: row["label"] for row in methods}),
    ]
    return Table(table, _cells(table, by, metrics, soft.unit), notes, text_columns=1 + bool(by))


def summary_table(
    soft: SoftFrames,
    times: SoftTimes,
    methods: Sequence[Mapping[str, Any]],
    by: str | None,
    metrics: Sequence[str],
    measured: Sequence[str],
    lights: Sequence[int],
) -> pd.DataFrame:
    """Tabulate methods, for each scene or radius if `by` names one.

    Columns: `scene`, or `number` and `radius` of the light, where rows are by these; `method`, `label`;
    `null`, the method if it is a null predictor; of `metrics`: those of frames with the ends of their
    intervals, `mse_off_edges` beside `mse`; `time` (ms), and those of `_in_sequences`.

    Args:
        times: of `time_methods`; the others: as of `table`.
    """
    errors, radii = soft.errors, {number: soft.radii[number] for number in lights}
    frames = errors[errors["scene"].isin(measured) & errors["radius"].isin(lights)]
    return pd.DataFrame(
        [
            group | _row(group_frames, times, row, metrics, lights)
            for group, group_frames in _groups(frames, by, measured, radii)
            for row in methods
        ]
    )


def _groups(
    frames: pd.DataFrame, by: str | None, scenes: Sequence[str], radii: Mapping[int, float]
) -> Iterator[tuple[dict[str, Any], pd.DataFrame]]:
    """Key columns and frames of each part of the table."""
    match by:
        case "scene":
            for scene in scenes:
                yield {"scene": scene}, frames[frames["scene"] == scene]
        case "radius":
            for number, radius in radii.items():
                yield {"number": number, "radius": radius}, frames[frames["radius"] == number]
        case _:
            yield {}, frames


def _row(
    frames: pd.DataFrame,
    times: SoftTimes,
    row: Mapping[str, Any],
    metrics: Sequence[str],
    lights: Sequence[int],
) -> dict[str, Any]:
    """A method's row: `method`, `label` and `metrics`."""
    own = frames[frames["method"] == row["method"]]
    values: dict[str, Any] = {"method": row["method"], "label": row["label"]}
    values["null"] = row["method"] if row["method"] in UNLEARNED else None
    for metric in (name for name in metrics if name in frame_metrics("soft")):
        values |= mean_with_interval(by_frame(own, metric), metric)
    if "mse" in metrics:
        values |= mean_with_interval(by_frame(own, OFF_EDGES), OFF_EDGES)
    if "time" in metrics:
        values["time"] = float(np.mean([cost(times, row["method"], k)["ms"] for k in lights]))
    if "temporal_error" in metrics:
        values |= _in_sequences(own)
    return values


def _in_sequences(own: pd.DataFrame) -> dict[str, float]:
    """Temporal errors by mover, the exact shadow's, and the squared error."""
    moves = own["part"].map(use_of)

    def mean(metric: str, mover: str) -> float:
        return float(own[(own["metric"] == metric) & (moves == mover)]["value"].mean())

    return {
        "temporal_error": mean("temporal_error", MOVES[0]),
        **{f"temporal_error_{mover}": mean("temporal_error", mover) for mover in MOVES[1:]},
        "temporal_error_reference": mean("temporal_error_reference", MOVES[0]),
        **{name: mean(name, MOVES[0]) for name in ("mse_sequence", "mse_sequence_off_edges")},
    }


def _cells(
    table: pd.DataFrame, by: str | None, metrics: Sequence[str], unit: str
) -> dict[str, Column | Iterable[str]]:
    """Format the cells by heading, without empty columns."""
    cells: dict[str, Column | Iterable[str]] = {}
    if by == "scene":
        cells["scene"] = table["scene"]
    if by == "radius":
        cells["light"] = [light_name(radius, unit) for radius in table["radius"]]
    cells["method"] = table["label"]
    for metric in metrics:
        if metric == "time":
            cells["ms"] = numbers(table["time"], "{:.1f}")
            cells["ms, printed"] = numbers(table["printed_time"], "{:.1f}")
            continue
        column = partial(metric_column, table, metric, digits=DIGITS.get(metric))
        cells[metrics_by_key()[metric].heading] = column(interval=metric == "mse")
        if metric == "mse":
            cells["off edges"] = metric_column(table, OFF_EDGES, interval=True, digits=2)
        cells[f"{metrics_by_key()[metric].name}, printed"] = column(f"printed_{metric}")
        if metric == "temporal_error":
            for mover in MOVES[1:]:
                cells[f"{mover} alone"] = column(f"{metric}_{mover}")
            cells["exact shadow's"] = column(f"{metric}_reference")
            in_sequence = f"{metrics_by_key()['mse'].label} in sequence"
            cells[in_sequence] = metric_column(table, "mse", "mse_sequence")
            cells["in sequence, off edges"] = metric_column(table, "mse", "mse_sequence_off_edges")
    return filled(cells)


def _describe_frames(
    soft: SoftFrames,
    metrics: Sequence[str],
    measured: Sequence[str],
    lights: Sequence[int],
    by: str | None,
) -> list[str]:
    if not {*frame_metrics("soft")} & {*metrics}:
        return []
    about, radii = soft.about, [soft.radii[number] for number in lights]
    frames = soft.errors[soft.errors["scene"].isin(measured)]
    first = frames[(frames["metric"] == "mse") & (frames["radius"] == lights[0])]
    count, scenes = first.groupby("method").size().max(), [*first["scene"].unique()]
    units = "95 % over the frames of each scene" if by == "scene" else describe_units(scenes, count)
    return [
        f"Mean over {count} frames of {about['width']} × {about['height']} of "
        f"{', '.join(scenes)}, and {len(radii)} radii of the light from {radii[0]:g} to "
        f"{radii[-1]:g} {soft.unit}, all of equal weight [{units}].",
        *([ABOUT_EDGES] if (frames["metric"] == OFF_EDGES).any() else []),
    ]


def _describe_printed(metrics: Sequence[str]) -> str:
    timed = ", milliseconds of an RTX 4090" * ("time" in metrics)
    return f"Printed: {phrases.TEXTS['kpnsm']}, of other scenes and whole frames of 2048 × 1024{timed}."


def _describe_sequences(errors: pd.DataFrame, measured: Sequence[str]) -> str:
    moving = errors[errors["metric"] == "temporal_error"]["scene"].unique()
    scenes = [scene for scene in moving if scene in measured]
    return (
        "Temporal error: root of the mean squared change of a point from frame to frame, over all "
        f"pixels (eq. 7), in sequences of {', '.join(scenes)}: light and camera move, or one of them "
        "alone. The exact shadow's is the true change. Blur lowers this error, so the squared error "
        "stands beside it."
    )
