"""Errors of screen-space networks by number of occluders (NSM, figure 12)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import screen_tables
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.occluder_error import MOST
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.frame_means import describe_units, mean_with_interval
from neural_shadows.reports.data.screen_rows import (
    ABOUT_NULLS,
    describe_trainings,
    learned_rows,
    nulls_in,
)
from neural_shadows.reports.data.table import Table, intervals, numbers, write_table
from neural_shadows.reports.data.width_notes import describe_widths
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import NetworksTable
from neural_shadows.settings.records import Run


class Settings(NetworksTable):
    """Networks' errors by number of solids before the light."""

    kind: Literal["screen_solids"] = Field(description="`screen_solids`")


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
    """Tabulate errors by network and number of solids.

    CSV: those of `solids_table`, and the scale.

    Args:
        widths_json: of `measure_widths`, for a note.
        soft_metrics: of each network on a frame set; trainings: training.json of each.
        frames_json: a part of its test frames.
        labels: by experiment, in the table's order.
    """
    records = {path.parent.name: read_json(path) for path in trainings}
    errors = read_soft_metrics(soft_metrics)
    soft = [number for number, radius in enumerate(read_json(frames_json)["radii"]) if radius > 0]
    errors = errors[errors["radius"].isin(soft)]
    whole = solids_table(errors, labels).assign(scale=run["scale"])
    table = learned_rows(whole)
    more = [" and more" * (number == MOST) for number in table["solids"]]
    columns = {
        "network": table["label"],
        "solids": [f"{number}{end}" for number, end in zip(table["solids"], more)],
        "MSE × 10⁻⁴": intervals(table, ["mse", "mse_low", "mse_high"], 1, 1e4),
        "the line": numbers(table["line"], "{:.1f}", 1e4),
        "each solid adds": intervals(table, ["slope", "slope_low", "slope_high"], 1, 1e4),
    }
    notes = [
        "Of pixels of test frames with so many solids between them and the light's centre, mean over "
        "all lights but a point light, which one solid hides as much as several "
        f"[{describe_units(*_frames(errors))}]. A solid: two surfaces on the ray to the light, "
        "or one of a sheet.",
        "Each solid adds: the slope of a line fitted to the squared errors of a frame's pixels over "
        "their numbers of solids, mean over frames. The line: with this slope through their means.",
        ABOUT_NULLS,
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    return Table(title, whole, columns, notes, text_columns=2)


def _frames(errors: pd.DataFrame) -> tuple[list[str], int]:
    """The scenes of test frames, and the number of frames."""
    frames = errors[["scene", "part", "frame"]].drop_duplicates()
    return [*frames["scene"].unique()], len(frames)


def solids_table(errors: pd.DataFrame, labels: Mapping[str, str]) -> pd.DataFrame:
    """Tabulate errors by network or null predictor and number of solids.

    Columns: `experiment`, `label`, `null` (see `nulls_in`), `solids`, `mse` and `slope` (what each solid adds, the same in all
    rows of a network) with the ends of their intervals over frames, `line`, the error at this number on
    a line of this slope.
    """
    # The sample is of frames: all lights of one together.
    keys = ["method", "metric", "scene", "part", "frame"]
    frames = errors.groupby(keys)["value"].mean().dropna()
    rows = []
    for experiment, label in (dict(labels) | nulls_in(errors)).items():
        own = frames[experiment]
        slope = _of_frames(own, "mse_per_solid", "slope")
        behind, middle = (_values(own, name).mean() for name in ("mse_behind", "solids_behind"))
        for number in range(1, MOST + 1):
            row = {"experiment": experiment, "label": label, "solids": number}
            row["null"] = None if experiment in labels else experiment
            row |= _of_frames(own, f"mse_solids_{number}", "mse")
            rows.append(row | {"line": behind + slope["slope"] * (number - middle)} | slope)
    return pd.DataFrame(rows)


def _of_frames(own: pd.Series, metric: str, name: str) -> dict[str, float]:
    """Mean of a metric over frames with its interval; NaN without frames."""
    return mean_with_interval(_values(own, metric), name)


def _values(own: pd.Series, metric: str) -> pd.Series:
    return own[own.index.get_level_values("metric") == metric]


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
