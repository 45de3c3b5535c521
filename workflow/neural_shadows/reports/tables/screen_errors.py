"""Errors of screen-space networks on training and on unseen scenes.

Datta et al. 2022, 4, figure 11, supplement 6 to 8.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import screen_tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.frame_means import OFF_EDGES, by_frame, mean_with_interval
from neural_shadows.reports.data.screen_rows import (
    ABOUT_NULLS,
    describe_trainings,
    learned_rows,
    nulls_in,
)
from neural_shadows.reports.data.table import Table, number_cells, write_table
from neural_shadows.reports.data.width_notes import describe_widths
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import NetworksTable
from neural_shadows.settings.records import Run, TrainingRecord

TRAINING, VALIDATION, SEQUENCES = "training", "validation", "sequences"
ALL = "all"  # lights of all radii
WIDTHS = {"width": "width, px", "width_reference": "exact width, px"}
SHOWN = {"mse": ("MSE × 10⁻⁴", 1e4), OFF_EDGES: ("MSE off edges × 10⁻⁴", 1e4)}
SHOWN |= {name: (text, 1) for name, text in WIDTHS.items()}


class Settings(NetworksTable):
    """Networks' errors by scene and light, beside those of training frames."""

    kind: Literal["screen_errors"] = Field(description="`screen_errors`")


def files(layout: Layout, table: str) -> dict[str, Any]:
    measured = screen_tables.files(layout, table, layout.entry("tables", table)["networks"])
    return measured | {"frames_json": screen_tables.frames_json(layout, table)}


def params(layout: Layout, table: str) -> dict[str, Any]:
    networks = layout.entry("tables", table)["networks"]
    return {"labels": screen_tables.labels(layout, networks), "run": layout.run()}


def table(
    *,
    soft_metrics: list[Path],
    trainings: list[Path],
    frames_json: Path,
    widths_json: Path | None = None,
    title: str,
    labels: Mapping[str, str],
    run: Run,
) -> Table:
    """Tabulate errors by network, kind of frames and light.

    CSV: those of `errors_table`, and the scale.

    Args:
        widths_json: of `measure_widths`, for a note.
        soft_metrics: of each network on the frame set; trainings: training.json of each.
        frames_json: a part of its test frames.
        labels: by experiment, in the table's order.
    """
    about = read_json(frames_json)
    records = {path.parent.name: read_json(path) for path in trainings}
    errors = read_soft_metrics(soft_metrics)
    radii = about.get("given_radii", about["radii"])
    table = errors_table(errors, records, labels, radii).assign(scale=run["scale"])
    columns = _cells(learned_rows(table), radii)
    notes = [
        f"By the light's radius, in {about.get('radius_unit', 'metres').replace('_', ' ')}. Width: the "
        "area of penumbrae (visibility 10 to 90 %, × 1.25) over the length of the hard shadow's "
        "edges, which is the same for all lights. "
        "A scene's row is of its test frames; sequences move the camera, the light or an object in the "
        "first scene.",
        *_describe_training("× training" in columns),
        ABOUT_NULLS,
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    return Table(title, table, columns, notes, text_columns=3)


def errors_table(
    errors: pd.DataFrame,
    records: Mapping[str, TrainingRecord],
    labels: Mapping[str, str],
    radii: Sequence[float],
) -> pd.DataFrame:
    """Tabulate errors by network or null predictor, kind of frames and light.

    Columns: `experiment`, `label`; `null`, the null predictor, None of networks; `frames`: `training`,
    `validation`, a scene's name for its test frames, `sequences`; `learned`: true on training scenes; `light`, the radius's
    number from 0, or `all`; `radius`; `mse` and `mse_off_edges` with the ends of their intervals over a
    scene's frames, NaN where only the mean is known; `width` and `width_reference` of the predicted and of the exact
    penumbrae of test frames; `ratio` to the error of training frames at the same light, NaN for lights
    without training.
    """
    rows = []
    for experiment, label in labels.items():
        own, record = errors[errors["method"] == experiment], records[experiment]
        same = list(record["radii"]) == list(radii)
        rows += [
            {"experiment": experiment, "label": label, "null": None, **row}
            for row in (*_training_errors(record, same), *_tested(own, record))
        ]
    record = next(iter(records.values()))
    for null, label in nulls_in(errors).items():
        own = errors[errors["method"] == null]
        rows += [
            {"experiment": null, "label": label, "null": null, **row}
            for row in (*_null_errors(null, record, radii), *_tested(own, record))
        ]
    table = pd.DataFrame(rows)
    table["radius"] = [np.nan if light == ALL else radii[int(light)] for light in table["light"]]
    base = table[table["frames"] == TRAINING].set_index(["experiment", "light"])["mse"]
    keys = pd.MultiIndex.from_frame(table[["experiment", "light"]])
    return table.assign(ratio=table["mse"].to_numpy() / base.reindex(keys).to_numpy())


def _training_errors(record: TrainingRecord, same: bool) -> Iterator[dict[str, Any]]:
    """Errors from the training itself; nothing if its lights differ."""
    for frames, name in ((TRAINING, "train_mse"), (VALIDATION, "validation_mse")):
        values = np.array(record[name], float) if same else np.array([])  # of None NaN
        lights = [*map(str, range(len(values))), ALL]
        for light, value in zip(lights, [*values, values.mean()] if same else []):
            ends = {"mse": value, "mse_low": np.nan, "mse_high": np.nan}
            yield {"frames": frames, "learned": frames == TRAINING, "light": light, **ends}


def _null_errors(
    null: str, record: TrainingRecord, radii: Sequence[float]
) -> Iterator[dict[str, Any]]:
    """Errors of a null predictor on validation frames, also as training frames."""
    name = {"hard": "hard_map"}.get(null, null)
    values = record.get("null_mse", {}).get(name)
    if values and list(record["radii"]) == list(radii):
        values_by_kind = {"train_mse": values, "validation_mse": values}
        yield from _training_errors(values_by_kind, True)


def _tested(own: pd.DataFrame, record: TrainingRecord) -> Iterator[dict[str, Any]]:
    """Errors on each scene's test frames, and on sequences."""
    for scene, frames in own.groupby("scene", sort=False):
        learned = scene in record["scenes"]
        errors = frames[frames["metric"].isin(("mse", OFF_EDGES))]
        for light, of_light in [*errors.groupby("radius"), (ALL, errors)] if len(errors) else []:
            row = {"frames": scene, "learned": learned, "light": str(light)}
            for metric in ("mse", OFF_EDGES):
                row |= mean_with_interval(by_frame(of_light, metric), metric)
            yield row | _widths(own, scene, light)
    paths = own[own["metric"] == "mse_sequence"]
    if len(paths):
        row = {"frames": SEQUENCES, "learned": paths["scene"].iloc[0] in record["scenes"]}
        row |= {"light": str(paths["radius"].iloc[0])}
        yield row | mean_with_interval(paths.set_index("scene")["value"], "mse")


def _widths(own: pd.DataFrame, scene: str, light: Any) -> dict[str, float]:
    shown = own[(own["scene"] == scene) & (own["radius"] == light)]
    return {name: shown[shown["metric"] == name]["value"].mean() for name in WIDTHS}


def _cells(table: pd.DataFrame, radii: Sequence[float]) -> dict[str, list[str]]:
    """Format a row for each network, kind of frames and number of `SHOWN`."""
    keys = ["label", "frames", "learned"]
    rows = []
    for (label, frames, learned), part in table.groupby(keys, sort=False):
        times = number_cells([part["ratio"].mean()], "{:.2f}")
        for name, (text, factor) in SHOWN.items():
            cells = dict(zip(part["light"], number_cells(part[name], "{:.1f}", factor)))
            texts = [cells.get(light, "") for light in (*map(str, range(len(radii))), ALL)]
            if any(texts):
                names = [label, _frames_name(frames, learned), text]
                rows.append([*names, *texts, *(times if name == "mse" else [""])])
    headings = ["network", "frames", "", *(f"{radius:g}" for radius in radii), "all lights"]
    columns = dict(zip([*headings, "× training"], map(list, zip(*rows))))
    return {heading: cells for heading, cells in columns.items() if any(cells)}


def _describe_training(has_ratio: bool) -> list[str]:
    if not has_ratio:
        return []
    return [
        "Training: a sample of the training frames, as large as the validation set. × training: the "
        "error over theirs, mean over the row's lights. Frames are drawn at random, and some are harder "
        "than others."
    ]


def _frames_name(frames: str, learned: bool) -> str:
    return frames if learned or frames == VALIDATION else f"{frames} (unseen)"


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
