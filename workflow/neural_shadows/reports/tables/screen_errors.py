"""Errors of screen-space networks on training and on unseen scenes.

Datta et al. 2022, 4, figure 11, supplement 6 to 8.
"""

from collections.abc import Iterator, Sequence
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.reports.data.frame_means import OFF_EDGES, squared_errors
from neural_shadows.reports.data.soft_frames import TrainedFrames, learned_rows
from neural_shadows.reports.data.table import Table, filled, number_cells
from neural_shadows.sections.frame_tables import NetworksTable
from neural_shadows.settings.records import TrainingRecord

TRAINING, VALIDATION, SEQUENCES = "training", "validation", "sequences"
ALL = "all"  # lights of all radii
HARD = "hard"  # the light map as it is
WIDTHS = {"width": "width, px", "width_reference": "exact width, px"}
SHOWN = {"mse": ("MSE × 10⁻⁴", 1e4), OFF_EDGES: ("MSE off edges × 10⁻⁴", 1e4)}
SHOWN |= {name: (text, 1) for name, text in WIDTHS.items()}


class Settings(NetworksTable):
    """Networks' errors by scene and light, beside those of training frames."""

    kind: Literal["screen_errors"] = Field(description="`screen_errors`")


def table(soft: TrainedFrames) -> Table:
    """Tabulate errors by network, kind of frames and light.

    CSV: those of `errors_table`, and the scale.
    """
    table = errors_table(soft)
    columns = _cells(learned_rows(table), soft.radii)
    unit = soft.about.get("radius_unit", "metres").replace("_", " ")
    notes = [
        f"By the light's radius, in {unit}. Width: the "
        "area of penumbrae (visibility 10 to 90 %, × 1.25) over the length of the hard shadow's "
        "edges, which is the same for all lights. "
        "A scene's row is of its test frames; sequences move the camera, the light or an object.",
        *_describe_training("× training" in columns),
        *soft.notes(),
    ]
    return Table(table, columns, notes, text_columns=3)


def errors_table(soft: TrainedFrames) -> pd.DataFrame:
    """Tabulate errors by network or null predictor, kind of frames and light.

    Columns: `experiment`, `label`; `null`, the null predictor, None of networks; `frames`:
    `training`, `validation`, a scene's name for its test frames, `sequences`; `learned`: true on
    training scenes; `light`, the radius's number from 0, or `all`; `radius`; `mse` and
    `mse_off_edges` with the ends of their intervals over a scene's frames, NaN where only the mean
    is known; `width` and `width_reference` of the predicted and of the exact penumbrae of test
    frames; `ratio` to the error of training frames at the same light, NaN for lights without
    training; `ratio_to_map` to the error of the light map as it is on the same frames, NaN without.
    """
    rows, errors, radii = [], soft.errors, soft.radii
    first = next(iter(soft.records.values()))
    for experiment, label in soft.labels_and_nulls.items():
        null = soft.null_of(experiment)
        own, record = (
            errors[errors["method"] == experiment],
            first if null else soft.records[experiment],
        )
        learned = _null_record(experiment, record) if null else record
        same = list(record["radii"]) == list(radii)
        rows += [
            {"experiment": experiment, "label": label, "null": null, **row}
            for row in (*_training_errors(learned, same), *_tested(own, record))
        ]
    table = pd.DataFrame(rows)
    table["radius"] = [np.nan if light == ALL else radii[int(light)] for light in table["light"]]
    training, hard = table[table["frames"] == TRAINING], table[table["null"] == HARD]
    return table.assign(
        ratio=_ratio(table, training, ["experiment", "light"]),
        ratio_to_map=_ratio(table, hard, ["frames", "learned", "light"]),
    )


def _ratio(table: pd.DataFrame, others: pd.DataFrame, keys: list[str]) -> np.ndarray:
    """Errors over those of the other rows with the same keys."""
    errors = others.set_index(keys)["mse"]
    return (
        table["mse"].to_numpy() / errors.reindex(pd.MultiIndex.from_frame(table[keys])).to_numpy()
    )


def _training_errors(record: TrainingRecord, same: bool) -> Iterator[dict[str, Any]]:
    """Errors from the training itself; nothing if its lights differ."""
    for frames, name in ((TRAINING, "train_mse"), (VALIDATION, "validation_mse")):
        values = np.array(record[name] if same else [], float)  # of None NaN
        lights = [*map(str, range(len(values))), ALL]
        for light, value in zip(lights, [*values, values.mean()] if len(values) else []):
            ends = {"mse": value, "mse_low": np.nan, "mse_high": np.nan}
            yield {"frames": frames, "learned": frames == TRAINING, "light": light, **ends}


def _null_record(null: str, record: TrainingRecord) -> TrainingRecord:
    """Errors of a null predictor on the training's frames."""
    name = "hard_map" if null == HARD else null
    keys = {"train_mse": "train_null_mse", "validation_mse": "null_mse"}
    return {key: record.get(nulls, {}).get(name, []) for key, nulls in keys.items()}


def _tested(own: pd.DataFrame, record: TrainingRecord) -> Iterator[dict[str, Any]]:
    """Errors on each scene's test frames, and on sequences."""
    for scene, frames in own.groupby("scene", sort=False):
        learned = scene in record["scenes"]
        errors = frames[frames["metric"].isin(("mse", OFF_EDGES))]
        for light, of_light in [*errors.groupby("radius"), (ALL, errors)] if len(errors) else []:
            row = {"frames": scene, "learned": learned, "light": str(light)}
            yield row | squared_errors(of_light) | _widths(own, scene, light)
    in_sequences = {"mse_sequence": "mse", "mse_sequence_off_edges": OFF_EDGES}
    moving = own[own["metric"].isin(in_sequences)]
    for learned, paths in moving.groupby(moving["scene"].isin(record["scenes"])):
        row = {"frames": SEQUENCES, "learned": learned, "light": str(paths["radius"].iloc[0])}
        yield row | squared_errors(paths.assign(metric=paths["metric"].map(in_sequences)))


def _widths(own: pd.DataFrame, scene: str, light: Any) -> dict[str, float]:
    shown = own[(own["scene"] == scene) & (own["radius"] == light)]
    return {name: shown[shown["metric"] == name]["value"].mean() for name in WIDTHS}


def _cells(table: pd.DataFrame, radii: Sequence[float]) -> dict[str, list[str]]:
    """Format a row for each network, kind of frames and number of `SHOWN`."""
    keys = ["label", "frames", "learned"]
    rows = []
    for (label, frames, learned), part in table.groupby(keys, sort=False):
        of_all = part["light"] == ALL
        means = part.loc[~of_all, "ratio"].mean(), part.loc[of_all, "ratio_to_map"].mean()
        times = number_cells(means, "{:.2f}")
        for name, (text, factor) in SHOWN.items():
            cells = dict(zip(part["light"], number_cells(part[name], "{:.1f}", factor)))
            texts = [cells.get(light, "") for light in (*map(str, range(len(radii))), ALL)]
            if any(texts):
                names = [label, _frames_name(frames, learned), text]
                rows.append([*names, *texts, *(times if name == "mse" else ["", ""])])
    headings = ["network", "frames", "", *(f"{radius:g}" for radius in radii), "all lights"]
    columns = dict(zip([*headings, "× training", "× map"], map(list, zip(*rows))))
    return filled(columns)


def _describe_training(has_ratio: bool) -> list[str]:
    if not has_ratio:
        return []
    return [
        "Training: a sample of the training frames, as large as the validation set. × training: the "
        "error over theirs, mean over the row's lights. × map: the error over that of the light map "
        "as it is on the same frames, over all lights. Some frames are harder than others: a network "
        "overfits if its × map is higher where it was not trained."
    ]


def _frames_name(frames: str, learned: bool) -> str:
    return frames if learned or frames == VALIDATION else f"{frames} (unseen)"
