"""How far networks on frames carry: errors on what they learned from, and on what they never saw
(Datta et al. 2022, 4, figure 11, supplement 6 to 8).
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
from neural_shadows.sections.frame_tables import FramesTable
from neural_shadows.settings.base import name_in
from neural_shadows.settings.records import Run, TrainingRecord

TRAINING, VALIDATION, SEQUENCES = "training", "validation", "sequences"
ALL = "all"  # lights of all radii
WIDTHS = {"width": "width, px", "width_reference": "exact width, px"}
SHOWN = {"mse": ("MSE × 10⁻⁴", 1e4), OFF_EDGES: ("MSE off edges × 10⁻⁴", 1e4)}
SHOWN |= {name: (text, 1) for name, text in WIDTHS.items()}


class Settings(FramesTable):
    """Networks' errors by scene and light, beside those on what they learned from."""

    kind: Literal["screen_errors"] = Field(description="`screen_errors`")
    networks: list[name_in("screen_experiments")] = Field(
        min_length=1, description="names in `screen_experiments`, in the table's order"
    )

    def methods_shown(self) -> list[str]:
        return self.networks


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
    """A row for each network, kind of frames and light.

    CSV: those of `errors_table`, and the scale.

    Args:
        widths_json: what `measure_widths` wrote of its test frames, for a note.
        soft_metrics: of each network on the frame set; trainings: training.json of each.
        frames_json: a part of its test frames.
        labels: by experiment, in the table's order.
    """
    about = read_json(frames_json)
    records = {path.parent.name: read_json(path) for path in trainings}
    found = read_soft_metrics(soft_metrics)
    radii = about.get("given_radii", about["radii"])
    table = errors_table(found, records, labels, radii).assign(scale=run["scale"])
    columns = _cells(learned_rows(table), radii)
    notes = [
        f"By the light's radius, in {about.get('radius_unit', 'metres').replace('_', ' ')}. Width: the "
        "area of penumbrae (visibility 10 to 90 %, × 1.25) over the length of the edges of the hard "
        "shadow, which is the same for all lights. "
        "A scene's row is of its test frames; sequences are paths through the first scene, of cameras, "
        "lights and an object.",
        *_describe_training("× training" in columns),
        ABOUT_NULLS,
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    return Table(title, table, columns, notes, text_columns=3)


def errors_table(
    found: pd.DataFrame,
    records: Mapping[str, TrainingRecord],
    labels: Mapping[str, str],
    radii: Sequence[float],
) -> pd.DataFrame:
    """A row for each network, kind of frames and light, and for what learns nothing.

    Columns: `experiment`, `label`; `null`, the method that learns nothing, None of networks; `frames`: `training`, `validation`, a scene's name for its test
    frames, `sequences`; `learned`, whether the network learned from the scene; `light`, the radius's
    number from 0, or `all`; `radius`; `mse` and `mse_off_edges` with the ends of their intervals over a
    scene's frames, NaN where only the mean is known; `width` and `width_reference` of the answered and of the exact penumbrae of test
    frames; `ratio` to that of training frames at the same light, NaN for lights that the
    network did not learn.
    """
    rows = []
    for experiment, label in labels.items():
        mine, record = found[found["method"] == experiment], records[experiment]
        same = list(record["radii"]) == list(radii)
        rows += [
            {"experiment": experiment, "label": label, "null": None, **row}
            for row in (*_learned(record, same), *_tested(mine, record))
        ]
    record = next(iter(records.values()))
    for null, label in nulls_in(found).items():
        mine = found[found["method"] == null]
        rows += [
            {"experiment": null, "label": label, "null": null, **row}
            for row in (*_unlearned(null, record, radii), *_tested(mine, record))
        ]
    table = pd.DataFrame(rows)
    table["radius"] = [np.nan if one == ALL else radii[int(one)] for one in table["light"]]
    base = table[table["frames"] == TRAINING].set_index(["experiment", "light"])["mse"]
    keys = pd.MultiIndex.from_frame(table[["experiment", "light"]])
    return table.assign(ratio=table["mse"].to_numpy() / base.reindex(keys).to_numpy())


def _learned(record: TrainingRecord, same: bool) -> Iterator[dict[str, Any]]:
    """What the training measured itself; nothing if that was of other lights."""
    for frames, name in ((TRAINING, "train_mse"), (VALIDATION, "validation_mse")):
        values = np.array(record[name], float) if same else np.array([])  # of None NaN
        lights = [*map(str, range(len(values))), ALL]
        for light, value in zip(lights, [*values, values.mean()] if same else []):
            ends = {"mse": value, "mse_low": np.nan, "mse_high": np.nan}
            yield {"frames": frames, "learned": frames == TRAINING, "light": light, **ends}


def _unlearned(
    null: str, record: TrainingRecord, radii: Sequence[float]
) -> Iterator[dict[str, Any]]:
    """What learns nothing, on validation frames; in place of training frames, which are like them."""
    name = {"hard": "hard_map"}.get(null, null)
    values = record.get("null_mse", {}).get(name)
    if values and list(record["radii"]) == list(radii):
        own = {"train_mse": values, "validation_mse": values}
        yield from _learned(own, True)


def _tested(mine: pd.DataFrame, record: TrainingRecord) -> Iterator[dict[str, Any]]:
    """Of each scene's test frames, and of sequences."""
    for scene, frames in mine.groupby("scene", sort=False):
        learned = scene in record["scenes"]
        errors = frames[frames["metric"].isin(("mse", OFF_EDGES))]
        for light, some in [*errors.groupby("radius"), (ALL, errors)] if len(errors) else []:
            row = {"frames": scene, "learned": learned, "light": str(light)}
            for metric in ("mse", OFF_EDGES):
                row |= mean_with_interval(by_frame(some, metric), metric)
            yield row | _widths(mine, scene, light)
    paths = mine[mine["metric"] == "mse_sequence"]
    if len(paths):
        row = {"frames": SEQUENCES, "learned": paths["scene"].iloc[0] in record["scenes"]}
        row |= {"light": str(paths["radius"].iloc[0])}
        yield row | mean_with_interval(paths.set_index("scene")["value"], "mse")


def _widths(mine: pd.DataFrame, scene: str, light: Any) -> dict[str, float]:
    here = mine[(mine["scene"] == scene) & (mine["radius"] == light)]
    return {name: here[here["metric"] == name]["value"].mean() for name in WIDTHS}


def _cells(table: pd.DataFrame, radii: Sequence[float]) -> dict[str, list[str]]:
    """The Markdown's: a row for each network, kind of frames and number of `SHOWN`."""
    keys = ["label", "frames", "learned"]
    rows = []
    for (label, frames, learned), here in table.groupby(keys, sort=False):
        times = number_cells([here["ratio"].mean()], "{:.2f}")
        for name, (text, factor) in SHOWN.items():
            cells = dict(zip(here["light"], number_cells(here[name], "{:.1f}", factor)))
            found = [cells.get(light, "") for light in (*map(str, range(len(radii))), ALL)]
            if any(found):
                names = [label, _frames_name(frames, learned), text]
                rows.append([*names, *found, *(times if name == "mse" else [""])])
    headings = ["network", "frames", "", *(f"{radius:g}" for radius in radii), "all lights"]
    columns = dict(zip([*headings, "× training"], map(list, zip(*rows))))
    return {heading: cells for heading, cells in columns.items() if any(cells)}


def _describe_training(known: bool) -> list[str]:
    if not known:
        return []
    return [
        "Training: of some of the frames that a network learned from, as many as are held out for "
        "validation. × training: the error over theirs, mean over the lights that a row has. Frames "
        "are drawn by chance, and some are harder than others."
    ]


def _frames_name(frames: str, learned: bool) -> str:
    known = learned or frames == VALIDATION
    return frames if known else f"{frames} (never seen)"


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
