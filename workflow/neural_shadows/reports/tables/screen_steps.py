"""Steps from a large screen-space network to a fast one.

Datta et al. 2022, 3.5, figure 8; Hu et al. 2025, 4.2.1.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.evaluation.soft_registry import in_format
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import screen_tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import unique
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.frame_means import (
    OFF_EDGES,
    by_frame,
    describe_units,
    mean_with_interval,
)
from neural_shadows.reports.data.published import printed_size, read_published
from neural_shadows.reports.data.screen_profiles import describe, product_share, run_name
from neural_shadows.reports.data.screen_rows import (
    ABOUT_NULLS,
    describe_trainings,
    learned_rows,
    nulls_in,
    with_printed,
)
from neural_shadows.reports.data.table import (
    Table,
    filled,
    intervals,
    number_cells,
    numbers,
    write_table,
)
from neural_shadows.reports.data.width_notes import describe_widths
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import FramesTable
from neural_shadows.settings.base import Model, Name, name_in
from neural_shadows.settings.records import Profile, Run

COLUMNS = (
    *("row", "null", "network", "precision", "run", "device", "runtime", "share", "size"),
    *("error", "error_low", "error_high"),
    *("error_off_edges", "error_off_edges_low", "error_off_edges_high"),
)
BYTES = {"float32": 4, "bfloat16": 2}


class Step(Model):
    """A step on the way to a fast network."""

    network: name_in("screen_networks") = Field(description="a name in `screen_networks`: timed")
    precision: Literal["float32", "bfloat16"] = Field(
        description="of its weights, its time and its error"
    )
    experiment: name_in("screen_experiments") | None = Field(
        None, description="a name in `screen_experiments`: its error, in this precision"
    )


class Settings(FramesTable):
    """From a large screen-space network to a fast one (Datta et al. 2022, 3.5)."""

    published: Literal["nsm.steps"] | None = Field(
        None, description="`nsm.steps`, the paper's printed numbers"
    )
    kind: Literal["screen_steps"] = Field(description="`screen_steps`")
    steps: dict[Name, Step] = Field(min_length=1, description="by the paper's names, in order")

    def methods_shown(self) -> list[str]:
        return [step.experiment for step in self.steps.values() if step.experiment]


def files(layout: Layout, table: str) -> dict[str, Any]:
    steps = layout.entry("tables", table)["steps"].values()
    trained = [step for step in steps if step["experiment"]]
    evaluated = [in_format(step["experiment"], step["precision"]) for step in trained]
    experiments = [step["experiment"] for step in trained]
    profiled = unique(step["network"] for step in steps)
    return screen_tables.files(layout, table, experiments, evaluated) | {
        "profiles": [layout.paths.screen_profile(name) for name in profiled],
        "published_nsm_csv": layout.source("config/published_nsm.csv"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    experiments = [step["experiment"] for step in settings["steps"].values() if step["experiment"]]
    return {
        **{key: settings[key] for key in ("published", "steps")},
        "labels": screen_tables.labels(layout, experiments),
        "run": layout.run(),
    }


def table(
    *,
    profiles: list[Path],
    soft_metrics: list[Path],
    trainings: list[Path],
    published_nsm_csv: Path,
    widths_json: Path | None = None,
    title: str,
    published: str | None,
    steps: Mapping[str, Mapping[str, Any]],
    labels: Mapping[str, str],
    run: Run,
) -> Table:
    """Tabulate time, size and error by step, beside printed numbers.

    CSV: those of `steps_table`, printed numbers and differences, `of_printed_size`, whether frames are
    timed that have the paper's, and the scale.

    Args:
        widths_json: of `measure_widths`, for a note.
        profiles: of `profile_screen_network`, of the steps' networks.
        soft_metrics: of the steps' experiments in their number formats; trainings: theirs.
        published: `nsm.steps`; None for steps that the paper does not print.
        steps: of each, by its name in the paper, `network`, `precision` and `experiment`, which may
            be None.
        labels: by experiment.
    """
    profiled = {path.stem: read_json(path) for path in profiles}
    records = {path.parent.name: read_json(path) for path in trainings}
    errors = read_soft_metrics(soft_metrics) if soft_metrics else None
    table = steps_table(steps, profiled, errors)
    printed_numbers = read_published(published_nsm_csv)
    sizes = [(profile["width"], profile["height"]) for profile in profiled.values()]
    table["of_printed_size"] = all(size == printed_size(printed_numbers) for size in sizes)
    for name in ("runtime", "size", "error"):
        table = with_printed(table, published, name, name, printed_numbers)
        bounds = [
            printed_numbers.get((published, row, f"{name}_above"), np.nan) for row in table["row"]
        ]
        table[f"printed_{name}_above"] = bounds
    whole = table.assign(scale=run["scale"])
    table = learned_rows(whole)
    cells = {
        "step": table["row"],
        "format": table["precision"],
        "ms": numbers(table["runtime"], "{:.1f}"),
        "printed": _printed(table, "runtime", "{:g}"),
        "share of the products' rate, %": numbers(table["share"], "{:.0f}", 100),
        "MiB": numbers(table["size"], "{:.2f}"),
        "printed, MB": _printed(table, "size", "{:g}"),
        "MSE × 10⁻³": intervals(table, ["error", "error_low", "error_high"], 2, 1e3),
        "off edges × 10⁻³": numbers(table["error_off_edges"], "{:.2f}", 1e3),
        "printed × 10⁻³": numbers(table["printed_error"], "{:.2f}", 1e3),
    }
    cells = filled(cells)
    printed = (
        f"Printed: {phrases.TEXTS['nsm']}, on an RTX 2080 Ti: milliseconds are of another "
        "machine. `original`: its width is not printed; ours gives the printed size, above 25 MB."
    )
    notes = [
        *([printed] if published else []),
        *_describe_errors(errors),
        *(describe(profile) for profile in list(profiled.values())[:1]),
        *_without_errors(table, steps),
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    heading = f"{title} ({phrases.TEXTS['nsm']}, 3.5)" if published else title
    return Table(heading, whole, cells, notes, text_columns=2)


def steps_table(
    steps: Mapping[str, Mapping[str, Any]],
    profiles: Mapping[str, Profile],
    errors: pd.DataFrame | None,
) -> pd.DataFrame:
    """Tabulate time, size and error by step, and errors of null predictors.

    Columns: `row`, `null` (see `nulls_in`), `network`, `precision`, `runtime` (ms of a frame on all of the machine's threads, or
    its GPU, see `run` and `device`), `share` of a matrix product's rate, `size` (MiB of weights and biases not
    counted), `error` (mean squared) and `error_off_edges` with the ends of their intervals, NaN of what is not
    trained. Times and errors are NaN, too, in a number format that the machine would emulate.
    """
    rows = []
    for name, step in steps.items():
        profile = profiles[step["network"]]
        timed = [run for run in profile["runs"] if run["precision"] == step["precision"]]
        weights = sum(level["weights"] for level in profile["levels"])
        row = {"row": name, "network": step["network"], "precision": step["precision"]}
        row |= {"run": "", "device": "", "runtime": np.nan, "share": np.nan}
        if timed:
            last = timed[-1]
            row |= {"run": run_name(last), "device": last["device"], "runtime": last["whole_ms"]}
            row |= {"share": product_share(profile, last)}
        row |= {"size": weights * BYTES[step["precision"]] / 2**20}
        row |= dict.fromkeys(("error", "error_low", "error_high"), np.nan)
        if step["experiment"]:
            row |= _errors(errors, in_format(step["experiment"], step["precision"]))
        rows.append(row | {"null": None})
    for null in nulls_in(errors) if errors is not None else ():
        rows.append({"row": null, "null": null} | _errors(errors, null))
    return pd.DataFrame(rows).reindex(columns=COLUMNS)


def _errors(errors: pd.DataFrame, method: str) -> dict[str, float]:
    own = errors[errors["method"] == method]
    means = mean_with_interval(by_frame(own, "mse"), "error")
    return means | mean_with_interval(by_frame(own, OFF_EDGES), "error_off_edges")


def _describe_errors(errors: pd.DataFrame | None) -> list[str]:
    if errors is None:
        return []
    frames = by_frame(errors, "mse")
    units = describe_units([*frames.index.unique("scene")], len(frames))
    return [
        f"Errors: mean over test frames and all lights, in the step's number format [{units}].",
        ABOUT_NULLS,
    ]


def _without_errors(table: pd.DataFrame, steps: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Describe trained steps without an error; nothing without such steps."""
    trained = table["row"].map(lambda name: bool(steps.get(name, {}).get("experiment")))
    lacking = table[table["error"].isna() & trained]
    if lacking.empty:
        return []
    names, formats = (", ".join(dict.fromkeys(lacking[name])) for name in ("row", "precision"))
    return [
        f"Without an error: {names}. Errors are measured on the CPU, which has no instructions for "
        f"{formats} and would emulate it."
    ]


def _printed(table: pd.DataFrame, name: str, form: str) -> list[str]:
    """Format printed numbers and lower bounds."""
    printed_numbers = number_cells(table[f"printed_{name}"], form)
    bounds = number_cells(table[f"printed_{name}_above"], f"> {form}")
    return [number or bound for number, bound in zip(printed_numbers, bounds)]


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
