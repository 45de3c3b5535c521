"""Methods for soft shadows over all lights together, beside what is printed of them (Hu et al. 2025,
tables 1 to 4, figures 7 and 9).
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases
from neural_shadows.reports.published_kpnsm import PAPER, read_published_kpnsm, titled
from neural_shadows.reports.soft_looks import UNITS, light_name
from neural_shadows.reports.tables.frame_means import ABOUT_EDGES, OFF_EDGES, describe_units
from neural_shadows.reports.tables.screen_rows import describe_trainings
from neural_shadows.reports.tables.soft_costs import describe_times
from neural_shadows.reports.tables.soft_summary_rows import MOVES, Row, summary_table, with_printed
from neural_shadows.reports.tables.width_notes import describe_widths
from neural_shadows.reports.tables.writing import interval_cells, number_cells, write_twins
from neural_shadows.running.stage import run_stage

HEADS = {
    "mse": ("MSE × 10⁻⁴ ↓", "{:.2f}", 1e4),
    "ssim": ("SSIM ↑", "{:.3f}", 1),
    "time": ("ms", "{:.1f}", 1),
    "temporal_error": ("temporal error × 10⁻² ↓", "{:.2f}", 100),
}


def write(
    *,
    frames_json: Path,
    soft_metrics: list[Path],
    soft_times: Path | None,
    widths_json: Path | None,
    trainings: list[Path],
    published_kpnsm_csv: Path,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    methods: Sequence[Row],
    by: str | None,
    metrics: Sequence[str],
    measured: Sequence[str],
    run: Mapping[str, Any],
) -> None:
    """Write a row for each method, or for each scene or radius and method.

    CSV: those of `summary_table` and `with_printed`, the radii's unit, and the scale.

    Args:
        frames_json: a part of the frame set's test frames.
        soft_metrics: of each method; trainings: training.json of the networks.
        soft_times: what `time_soft_methods` wrote; None where `metrics` has no time.
        widths_json: what `measure_widths` wrote; None for frames without targets.
        published: `kpnsm.` and the paper's number of the table; None for one that it only draws.
        methods: `method`, `label` and, None if nothing is printed, `published` and `column`.
        by: `scene`, `radius`, or None; metrics: of `HEADS`.
        measured: the scenes whose frames count.
    """
    about = read_json(frames_json)
    found = read_soft_metrics(soft_metrics)
    times = read_json(soft_times) if soft_times else {"methods": {}}
    unit = UNITS[about.get("radius_unit", "metres")]
    radii = about.get("given_radii", about["radii"])
    numbers = read_published_kpnsm(published_kpnsm_csv)
    asked = {"methods": methods, "by": by, "metrics": metrics, "measured": measured}
    table = summary_table(found, times, radii, **asked)
    for metric in metrics:
        first = metric == metrics[0]  # a column of the paper's own is of this one
        table = with_printed(table, metric, first, published, methods, numbers)
    table = table.assign(unit=unit, scale=run["scale"])
    notes = [
        *_describe_frames(
            found[found["scene"].isin(measured)], metrics, about, radii, unit, by == "scene"
        ),
        *describe_widths(widths_json, measured),
        *([_describe_sequences(found)] if "temporal_error" in metrics else []),
        *([_describe_printed(metrics)] if published else []),
        *describe_times(times),
        *describe_trainings(_records(trainings), {row["method"]: row["label"] for row in methods}),
        phrases.describe_run(run),
    ]
    heading, cells = titled(title, published), _cells(table, by, metrics, unit)
    write_twins(table, cells, csv, md, title=heading, notes=notes, text_columns=1 + bool(by))


def _cells(
    table: pd.DataFrame, by: str | None, metrics: Sequence[str], unit: str
) -> dict[str, Sequence[str]]:
    """What the Markdown shows, by heading; columns without anything are left out."""
    cells: dict[str, Sequence[str]] = {}
    if by == "scene":
        cells["scene"] = table["scene"]
    if by == "radius":
        cells["light"] = [light_name(radius, unit) for radius in table["radius"]]
    cells["method"] = table["label"]
    for metric in metrics:
        head, form, factor = HEADS[metric]
        cells[head] = number_cells(table[metric], form, factor)
        if metric == "mse":
            cells[head] = interval_cells(table, ["mse", "mse_low", "mse_high"], 2, factor)
            ends = [OFF_EDGES, f"{OFF_EDGES}_low", f"{OFF_EDGES}_high"]
            cells["off edges"] = interval_cells(table, ends, 2, factor)
        printed = table[f"printed_{metric}"]
        cells[f"{head.split(' ×')[0].strip(' ↓↑')}, printed"] = number_cells(printed, form, factor)
        if metric == "temporal_error":
            for what in MOVES[1:]:
                cells[f"{what} alone"] = number_cells(table[f"{metric}_{what}"], form, factor)
            cells["exact shadow's"] = number_cells(table[f"{metric}_reference"], form, factor)
            cells["MSE × 10⁻⁴ in sequence"] = number_cells(table["mse_sequence"], "{:.1f}", 1e4)
    return {head: column for head, column in cells.items() if any(column)}


def _records(trainings: Sequence[Path]) -> dict[str, Any]:
    return {path.parent.name: read_json(path) for path in trainings}


def _describe_frames(
    frames: pd.DataFrame,
    metrics: Sequence[str],
    about: Mapping[str, Any],
    radii: Sequence[float],
    unit: str,
    by_scene: bool,
) -> list[str]:
    if not {"mse", "ssim"} & set(metrics):
        return []
    one = frames[(frames["metric"] == "mse") & (frames["radius"] == 0)]
    count, scenes = one.groupby("method").size().max(), [*one["scene"].unique()]
    units = "95 % over the frames of each scene" if by_scene else describe_units(scenes, count)
    return [
        f"Mean over {count} frames of {about['width']} × {about['height']} of "
        f"{', '.join(scenes)}, and {len(radii)} radii of the light from {radii[0]:g} to "
        f"{radii[-1]:g} {unit}, all with the same weight [{units}].",
        *([ABOUT_EDGES] if (frames["metric"] == OFF_EDGES).any() else []),
    ]


def _describe_printed(metrics: Sequence[str]) -> str:
    timed = ", milliseconds of an RTX 4090" * ("time" in metrics)
    return f"Printed: {PAPER}, of other scenes and whole frames of 2048 × 1024{timed}."


def _describe_sequences(found: pd.DataFrame) -> str:
    where = found[found["metric"] == "temporal_error"]["scene"].unique()
    return (
        "Temporal error: root of the mean squared change along a point's way from frame to frame, "
        f"over all pixels (eq. 7), in a sequence of {', '.join(where)} in which light and camera move, "
        "or one of them alone; the exact shadow's own is what truly changes. Blur lowers it: so the "
        "squared error stands beside it."
    )


if "snakemake" in globals():
    run_stage(snakemake, write)
