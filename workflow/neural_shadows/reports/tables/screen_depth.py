"""Networks of several depths by width of penumbrae (NSM, table 1)."""

from collections.abc import Mapping
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
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.frame_means import OFF_EDGES, mean_with_interval
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.screen_rows import (
    ABOUT_NULLS,
    describe_trainings,
    learned_rows,
    nulls_in,
    with_printed,
)
from neural_shadows.reports.data.table import Table, filled, number_cells, numbers, write_table
from neural_shadows.reports.data.width_notes import describe_widths
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import FramesTable
from neural_shadows.settings.base import Name, name_in
from neural_shadows.settings.records import Run, TrainingRecord

SUFFICES = 2.0  # times a row's least error: a worse network has too few levels (claim 3.6)


class Settings(FramesTable):
    """Trained networks of several depths on penumbrae of several widths."""

    published: str | None = Field(
        None, pattern=r"^nsm\.1$", description="`nsm.` and the paper's number of this table"
    )
    kind: Literal["screen_depth"] = Field(description="`screen_depth`")
    columns: dict[Name, name_in("screen_experiments")] = Field(
        min_length=1, description="a name in `screen_experiments` for each of the paper's names"
    )

    def methods_shown(self) -> list[str]:
        return [*self.columns.values()]


def files(layout: Layout, table: str) -> dict[str, Any]:
    methods = layout.entry("tables", table)["columns"].values()
    measured = screen_tables.files(layout, table, methods)
    return measured | {
        "frames_json": screen_tables.frames_json(layout, table),
        "published_nsm_csv": layout.source("config/published_nsm.csv"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    return {
        **{key: settings[key] for key in ("published", "columns")},
        "labels": screen_tables.labels(layout, settings["columns"].values()),
        "run": layout.run(),
    }


def table(
    *,
    soft_metrics: list[Path],
    trainings: list[Path],
    frames_json: Path,
    published_nsm_csv: Path,
    widths_json: Path | None = None,
    title: str,
    published: str | None,
    columns: Mapping[str, str],
    labels: Mapping[str, str],
    run: Run,
) -> Table:
    """Tabulate squared errors by scene and network, for the largest light.

    CSV: those of `depth_table`, printed numbers and differences, and the scale.

    Args:
        widths_json: of `measure_widths`, for a note.
        soft_metrics: of each network on the frame set; trainings: training.json of each.
        frames_json: a part of its test frames.
        published: the paper's number of the table; None without printed numbers.
        columns: the experiment of each printed column; labels: by experiment.
    """
    about = read_json(frames_json)
    records = {path.parent.name: read_json(path) for path in trainings}
    errors = read_soft_metrics(soft_metrics)
    table = depth_table(errors, len(about["radii"]) - 1, columns, labels, records)
    printed_numbers = read_published(published_nsm_csv)
    table = with_printed(table, published, "mse", None, printed_numbers)
    whole = table.assign(scale=run["scale"])
    table = learned_rows(whole)
    parts = {
        "penumbra": [row.replace("penumbra_", "") + " px" for row in table["row"].unique()],
    }
    for column, label in zip(columns, (labels[name] for name in columns.values())):
        part = table[table["column"] == column]
        parts[label] = numbers(part["mse"], "{:.4f}")
        parts[f"{label}, printed"] = numbers(part["printed_mse"], "{:.3f}")
    parts["of the widest"] = [
        " / ".join(number_cells(part["mse_widest"], "{:.4f}"))
        for _, part in table.groupby("row", sort=False)
    ]
    parts["× best"] = [
        " / ".join(number_cells(part["ratio"], "{:.1f}"))
        for _, part in table.groupby("row", sort=False)
    ]
    notes = [
        f"Squared error of visibility for a light of {about['radii'][-1]:g} m, mean over the test "
        f"frames of {about['width']} × {about['height']}. × best: the error over the least of its "
        "row; a network with a receptive field (3 · 2^levels pixels) narrower than the "
        f"penumbra should have {SUFFICES:g} or more. Of the widest: of the tenth of each frame's penumbra "
        "pixels with the widest penumbrae by the paper's model (3.6).",
        ABOUT_NULLS,
        _describe_learning(records, labels),
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    parts = filled(parts)
    return Table(phrases.titled(title, published), whole, parts, notes)


def depth_table(
    errors: pd.DataFrame,
    radius: int,
    columns: Mapping[str, str],
    labels: Mapping[str, str],
    records: Mapping[str, TrainingRecord],
) -> pd.DataFrame:
    """Tabulate errors by scene and network or null predictor.

    Columns: `row` (`penumbra_21` of the scene `plate_21`), `column`, `experiment`, `label`, `null` (see
    `nulls_in`), `receptive_field` in pixels, `mse` and `mse_off_edges` with the ends of their intervals over
    a scene's frames, `mse_widest` of
    the tenth of a frame's penumbra pixels with the widest penumbrae, `ratio` of `mse` to the least of
    its row.
    """
    rows, nulls = [], nulls_in(errors)
    for scene, frames in errors[errors["radius"] == radius].groupby("scene", sort=False):
        for column, experiment in [*columns.items(), *zip(nulls, nulls)]:
            null = experiment if experiment in nulls else None
            own = frames[frames["method"] == experiment].set_index(["scene", "metric"])["value"]
            levels = 0 if null else len(records[experiment]["network"]["widths"])
            row = {"row": scene.replace("plate_", "penumbra_"), "column": column, "null": null}
            row |= {"experiment": experiment, "label": (nulls | dict(labels))[experiment]}
            row |= {"receptive_field": 3 * 2**levels if levels else np.nan}
            for metric in ("mse", OFF_EDGES):
                row |= mean_with_interval(_of_metric(own, metric), metric)
            rows.append(row | {"mse_widest": _of_metric(own, "mse_widest").mean()})
    table = pd.DataFrame(rows)
    least = table[table["null"].isna()].groupby("row")["mse"].min()
    return table.assign(ratio=table["mse"] / table["row"].map(least))


def _of_metric(values: pd.Series, metric: str) -> pd.Series:
    return values[values.index.get_level_values("metric") == metric]


def _describe_learning(records: Mapping[str, TrainingRecord], labels: Mapping[str, str]) -> str:
    """Describe errors over steps: a deeper network may only lack training."""
    texts = []
    for name, record in records.items():
        end = {"step": record["training"]["steps"], "mse": record["validation_mse"]}
        validations = [*record["validations"], end]
        quarters = np.linspace(0, len(validations) - 1, 4).round().astype(int)
        shown = [validations[number] for number in dict.fromkeys(quarters)]
        errors = number_cells([np.mean(point["mse"], dtype=float) for point in shown], short, 1e4)
        after = [f"{error} after {point['step']:,}" for error, point in zip(errors, shown)]
        texts.append(f"{labels.get(name, name)} {', '.join(after)}")
    return (
        "An error that falls until the end is of a network short of training. Squared error × 10⁻⁴ on "
        f"validation frames, mean over all lights, by steps: {'; '.join(texts)}."
    )


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
