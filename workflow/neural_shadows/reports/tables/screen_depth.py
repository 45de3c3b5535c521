"""Networks of several depths against the width of penumbrae (Datta et al. 2022, table 1)."""

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
from neural_shadows.reports.data.published_nsm import read_published_nsm, titled
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

SUFFICES = 2.0  # times a row's least error: what is worse has too few levels (claim 3.6)


class Settings(FramesTable):
    """Trained networks of several depths on penumbrae of several widths."""

    published: str | None = Field(
        None, pattern=r"^nsm\.1$", description="`nsm.` and the paper's number of this table"
    )
    kind: Literal["screen_depth"] = Field(description="`screen_depth`")
    columns: dict[Name, name_in("screen_experiments")] = Field(
        min_length=1, description="a name in `screen_experiments` for each name that the paper has"
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
    """A row for each scene and network: squared error of the largest light's shadow.

    CSV: those of `depth_table`, printed numbers and differences, and the scale.

    Args:
        widths_json: what `measure_widths` wrote of its test frames, for a note.
        soft_metrics: of each network on the frame set; trainings: training.json of each.
        frames_json: a part of its test frames.
        published: the paper's number of the table; None for one that it only draws.
        columns: the experiment of each printed column; labels: by experiment.
    """
    about = read_json(frames_json)
    records = {path.parent.name: read_json(path) for path in trainings}
    found = read_soft_metrics(soft_metrics)
    table = depth_table(found, len(about["radii"]) - 1, columns, labels, records)
    printed_numbers = read_published_nsm(published_nsm_csv)
    table = with_printed(table, published, "mse", None, printed_numbers)
    whole = table.assign(scale=run["scale"])
    table = learned_rows(whole)
    parts = {
        "penumbra": [one.replace("penumbra_", "") + " px" for one in table["row"].unique()],
    }
    for column, label in zip(columns, (labels[name] for name in columns.values())):
        here = table[table["column"] == column]
        parts[label] = numbers(here["mse"], "{:.4f}")
        parts[f"{label}, printed"] = numbers(here["printed_mse"], "{:.3f}")
    parts["of the widest"] = [
        " / ".join(number_cells(here["mse_widest"], "{:.4f}"))
        for _, here in table.groupby("row", sort=False)
    ]
    parts["× best"] = [
        " / ".join(number_cells(here["ratio"], "{:.1f}"))
        for _, here in table.groupby("row", sort=False)
    ]
    notes = [
        f"Squared error of visibility for a light of {about['radii'][-1]:g} m, mean over the test "
        f"frames of {about['width']} × {about['height']}. × best: of each network, times the least "
        f"of its row; a network whose receptive field (3 · 2^levels pixels) is narrower than the "
        f"penumbra should have {SUFFICES:g} or more. Of the widest: of the tenth of each frame's penumbra "
        "pixels whose penumbra is widest by the paper's model (3.6).",
        ABOUT_NULLS,
        _describe_learning(records, labels),
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    parts = filled(parts)
    return Table(titled(title, published), whole, parts, notes)


def depth_table(
    found: pd.DataFrame,
    radius: int,
    columns: Mapping[str, str],
    labels: Mapping[str, str],
    records: Mapping[str, TrainingRecord],
) -> pd.DataFrame:
    """A row for each scene and network, and for what learns nothing.

    Columns: `row` (`penumbra_21` of the scene `plate_21`), `column`, `experiment`, `label`, `null` (see
    `nulls_in`), `receptive_field` in pixels, `mse` and `mse_off_edges` with the ends of their intervals over
    a scene's frames, `mse_widest` of
    the tenth of a frame's penumbra pixels whose penumbra is widest, `ratio` of `mse` to the least of
    its row.
    """
    rows, nulls = [], nulls_in(found)
    for scene, frames in found[found["radius"] == radius].groupby("scene", sort=False):
        for column, experiment in [*columns.items(), *zip(nulls, nulls)]:
            null = experiment if experiment in nulls else None
            mine = frames[frames["method"] == experiment].set_index(["scene", "metric"])["value"]
            levels = 0 if null else len(records[experiment]["network"]["widths"])
            row = {"row": scene.replace("plate_", "penumbra_"), "column": column, "null": null}
            row |= {"experiment": experiment, "label": (nulls | dict(labels))[experiment]}
            row |= {"receptive_field": 3 * 2**levels if levels else np.nan}
            for metric in ("mse", OFF_EDGES):
                row |= mean_with_interval(_of(mine, metric), metric)
            rows.append(row | {"mse_widest": _of(mine, "mse_widest").mean()})
    table = pd.DataFrame(rows)
    least = table[table["null"].isna()].groupby("row")["mse"].min()
    return table.assign(ratio=table["mse"] / table["row"].map(least))


def _of(mine: pd.Series, metric: str) -> pd.Series:
    return mine[mine.index.get_level_values("metric") == metric]


def _describe_learning(records: Mapping[str, TrainingRecord], labels: Mapping[str, str]) -> str:
    """Errors over the steps: a deeper network may be behind only because it has learned too little."""
    told = []
    for name, record in records.items():
        end = {"step": record["training"]["steps"], "mse": record["validation_mse"]}
        found = [*record["validations"], end]
        quarters = np.linspace(0, len(found) - 1, 4).round().astype(int)
        shown = [found[number] for number in dict.fromkeys(quarters)]
        errors = number_cells([np.mean(one["mse"], dtype=float) for one in shown], short, 1e4)
        after = [f"{error} after {one['step']:,}" for error, one in zip(errors, shown)]
        told.append(f"{labels.get(name, name)} {', '.join(after)}")
    return (
        "What falls until the end has not learned all that it can; squared error × 10⁻⁴ on validation "
        f"frames, mean over all lights, by steps: {'; '.join(told)}."
    )


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
