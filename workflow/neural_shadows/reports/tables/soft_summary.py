"""Methods for soft shadows over all lights, beside printed numbers.

Hu et al. 2025, tables 1 to 4, figures 7 and 9.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field, model_validator

from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.frame_means import ABOUT_EDGES, OFF_EDGES, describe_units
from neural_shadows.reports.data.lights import UNITS, light_name
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.screen_rows import describe_trainings
from neural_shadows.reports.data.soft_costs import describe_times
from neural_shadows.reports.data.soft_summary_rows import MOVES, Row, summary_table, with_printed
from neural_shadows.reports.data.table import Column, Table, filled, intervals, numbers, write_table
from neural_shadows.reports.data.width_notes import describe_widths
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import MethodsTable
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Model, Name, Text, section_or
from neural_shadows.settings.records import PartRecord, Run

HEADS = {
    "mse": ("MSE × 10⁻⁴ ↓", "{:.2f}", 1e4),
    "ssim": ("SSIM ↑", "{:.3f}", 1),
    "time": ("ms", "{:.1f}", 1),
    "temporal_error": ("temporal error × 10⁻² ↓", "{:.2f}", 100),
}


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
    over: Literal["trained", "unseen"] = Field(
        "trained", description="whose test frames: those of the set's `scenes` or of its `unseen`"
    )
    by: Literal["scene", "radius"] | None = Field(
        None, description="a part of the table for each; without it one row a method"
    )
    metrics: list[Literal["mse", "ssim", "time", "temporal_error"]] = Field(
        ["mse", "ssim"],
        min_length=1,
        description="`temporal_error` is of sequences, of the set's first scene",
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


def files(layout: Layout, table: str) -> dict[str, Any]:
    frame_set = soft_methods.frame_set(layout, table)
    return {
        "frames_json": soft_methods.tests(layout, frame_set)[0],
        "soft_metrics": soft_methods.evaluations(layout, table, "csv"),
        "soft_times": soft_methods.times(layout, table),
        "widths_json": soft_methods.widths(layout, frame_set),
        "trainings": soft_methods.trainings(layout, table),
        "published_kpnsm_csv": layout.source("config/published_kpnsm.csv"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    available = soft_methods.methods(layout, table)
    labelled = [
        row | {"label": row["label"] or soft_methods.label(layout, row["method"])}
        for row in settings["methods"]
        if row["method"] in available
    ]
    return {
        **{key: settings[key] for key in ("published", "by", "metrics")},
        "methods": labelled,
        "measured": soft_methods.shown_scenes(layout, table),
        "run": layout.run(),
    }


def table(
    *,
    frames_json: Path,
    soft_metrics: list[Path],
    soft_times: Path | None,
    widths_json: Path | None,
    trainings: list[Path],
    published_kpnsm_csv: Path,
    title: str,
    published: str | None,
    methods: Sequence[Row],
    by: str | None,
    metrics: Sequence[str],
    measured: Sequence[str],
    run: Run,
) -> Table:
    """Tabulate methods, for each scene or radius if `by` names one.

    CSV: those of `summary_table` and `with_printed`, the radii's unit, and the scale.

    Args:
        frames_json: a part of the frame set's test frames.
        soft_metrics: of each method; trainings: training.json of the networks.
        soft_times: of `time_soft_methods`; None where `metrics` has no time.
        widths_json: of `measure_widths`; None for frames without targets.
        published: `kpnsm.` and the paper's number of the table; None without printed numbers.
        methods: `method`, `label` and, None if nothing is printed, `published` and `column`.
        by: `scene`, `radius`, or None; metrics: of `HEADS`.
        measured: the scenes whose frames count.
    """
    about = read_json(frames_json)
    errors = read_soft_metrics(soft_metrics)
    times = read_json(soft_times) if soft_times else {"methods": {}}
    unit = UNITS[about.get("radius_unit", "metres")]
    radii = about.get("given_radii", about["radii"])
    printed_numbers = read_published(published_kpnsm_csv)
    rows = {"methods": methods, "by": by, "metrics": metrics, "measured": measured}
    table = summary_table(errors, times, radii, **rows)
    for metric in metrics:
        first = metric == metrics[0]  # the metric of `column`
        table = with_printed(table, metric, first, published, methods, printed_numbers)
    table = table.assign(unit=unit, scale=run["scale"])
    notes = [
        *_describe_frames(
            errors[errors["scene"].isin(measured)], metrics, about, radii, unit, by == "scene"
        ),
        *describe_widths(widths_json, measured),
        *([_describe_sequences(errors)] if "temporal_error" in metrics else []),
        *([_describe_printed(metrics)] if published else []),
        *describe_times(times),
        *describe_trainings(_records(trainings), {row["method"]: row["label"] for row in methods}),
        phrases.describe_run(run),
    ]
    heading, cells = phrases.titled(title, published), _cells(table, by, metrics, unit)
    return Table(heading, table, cells, notes, text_columns=1 + bool(by))


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
        head, form, factor = HEADS[metric]
        cells[head] = numbers(table[metric], form, factor)
        if metric == "mse":
            cells[head] = intervals(table, ["mse", "mse_low", "mse_high"], 2, factor)
            ends = [OFF_EDGES, f"{OFF_EDGES}_low", f"{OFF_EDGES}_high"]
            cells["off edges"] = intervals(table, ends, 2, factor)
        printed = table[f"printed_{metric}"]
        cells[f"{head.split(' ×')[0].strip(' ↓↑')}, printed"] = numbers(printed, form, factor)
        if metric == "temporal_error":
            for mover in MOVES[1:]:
                cells[f"{mover} alone"] = numbers(table[f"{metric}_{mover}"], form, factor)
            cells["exact shadow's"] = numbers(table[f"{metric}_reference"], form, factor)
            cells["MSE × 10⁻⁴ in sequence"] = numbers(table["mse_sequence"], "{:.1f}", 1e4)
    return filled(cells)


def _records(trainings: Sequence[Path]) -> dict[str, Any]:
    return {path.parent.name: read_json(path) for path in trainings}


def _describe_frames(
    frames: pd.DataFrame,
    metrics: Sequence[str],
    about: PartRecord,
    radii: Sequence[float],
    unit: str,
    by_scene: bool,
) -> list[str]:
    if not {"mse", "ssim"} & set(metrics):
        return []
    first = frames[(frames["metric"] == "mse") & (frames["radius"] == 0)]
    count, scenes = first.groupby("method").size().max(), [*first["scene"].unique()]
    units = "95 % over the frames of each scene" if by_scene else describe_units(scenes, count)
    return [
        f"Mean over {count} frames of {about['width']} × {about['height']} of "
        f"{', '.join(scenes)}, and {len(radii)} radii of the light from {radii[0]:g} to "
        f"{radii[-1]:g} {unit}, all of equal weight [{units}].",
        *([ABOUT_EDGES] if (frames["metric"] == OFF_EDGES).any() else []),
    ]


def _describe_printed(metrics: Sequence[str]) -> str:
    timed = ", milliseconds of an RTX 4090" * ("time" in metrics)
    return f"Printed: {phrases.TEXTS['kpnsm']}, of other scenes and whole frames of 2048 × 1024{timed}."


def _describe_sequences(errors: pd.DataFrame) -> str:
    scenes = errors[errors["metric"] == "temporal_error"]["scene"].unique()
    return (
        "Temporal error: root of the mean squared change of a point from frame to frame, over all "
        f"pixels (eq. 7), in a sequence of {', '.join(scenes)}: light and camera move, or one of them "
        "alone. The exact shadow's is the true change. Blur lowers this error, so the squared error "
        "stands beside it."
    )


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
