"""From a large network of whole frames to a fast one, step by step (Datta et al. 2022, 3.5, figure 8;
Hu et al. 2025, 4.2.1).
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.soft_method_names import in_format
from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases
from neural_shadows.reports.published_nsm import PAPER, printed_size, read_published_nsm
from neural_shadows.reports.screen_profiles import describe, product_share, run_name
from neural_shadows.reports.tables.frame_means import (
    OFF_EDGES,
    by_frame,
    describe_units,
    mean_with_interval,
)
from neural_shadows.reports.tables.screen_rows import (
    ABOUT_NULLS,
    describe_trainings,
    learned_rows,
    nulls_in,
    with_printed,
)
from neural_shadows.reports.tables.width_notes import describe_widths
from neural_shadows.reports.tables.writing import interval_cells, number_cells, write_twins
from neural_shadows.running.stage import run_stage

COLUMNS = (
    *("row", "null", "network", "precision", "run", "device", "runtime", "share", "size"),
    *("error", "error_low", "error_high"),
    *("error_off_edges", "error_off_edges_low", "error_off_edges_high"),
)
BYTES = {"float32": 4, "bfloat16": 2}


def write(
    *,
    profiles: list[Path],
    soft_metrics: list[Path],
    trainings: list[Path],
    published_nsm_csv: Path,
    widths_json: Path | None = None,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    steps: Mapping[str, Mapping[str, Any]],
    labels: Mapping[str, str],
    run: Mapping[str, Any],
) -> None:
    """Write a row for each step: time, size and error, each beside the printed.

    CSV: those of `steps_table`, printed numbers and differences, `of_printed_size`, whether frames are
    timed that have the paper's, and the scale.

    Args:
        widths_json: what `measure_widths` wrote of its test frames, for a note.
        profiles: what `profile_screen_network` wrote of the steps' networks.
        soft_metrics: of the steps' experiments in their number formats; trainings: theirs.
        published: `nsm.steps`; None for steps that the paper does not print.
        steps: of each, by its name in the paper, `network`, `precision` and `experiment`, which may
            be None.
        labels: by experiment.
    """
    profiled = {path.stem: read_json(path) for path in profiles}
    records = {path.parent.name: read_json(path) for path in trainings}
    found = read_soft_metrics(soft_metrics) if soft_metrics else None
    table = steps_table(steps, profiled, found)
    numbers = read_published_nsm(published_nsm_csv)
    sizes = [(one["width"], one["height"]) for one in profiled.values()]
    # The other paper's frames have this size, too.
    table["of_printed_size"] = all(size == printed_size(numbers) for size in sizes)
    for name in ("runtime", "size", "error"):
        table = with_printed(table, published, name, name, numbers)
        bounds = [numbers.get((published, row, f"{name}_above"), np.nan) for row in table["row"]]
        table[f"printed_{name}_above"] = bounds
    whole = table.assign(scale=run["scale"])
    table = learned_rows(whole)
    cells = {
        "step": table["row"],
        "format": table["precision"],
        "ms": number_cells(table["runtime"], "{:.1f}"),
        "printed": _printed(table, "runtime", "{:g}"),
        "share of the products' rate, %": number_cells(table["share"], "{:.0f}", 100),
        "MiB": number_cells(table["size"], "{:.2f}"),
        "printed, MB": _printed(table, "size", "{:g}"),
        "MSE × 10⁻³": interval_cells(table, ["error", "error_low", "error_high"], 2, 1e3),
        "off edges × 10⁻³": number_cells(table["error_off_edges"], "{:.2f}", 1e3),
        "printed × 10⁻³": number_cells(table["printed_error"], "{:.2f}", 1e3),
    }
    cells = {name: column for name, column in cells.items() if any(column)}
    printed = (
        f"Printed: {PAPER}, on an RTX 2080 Ti; another machine's milliseconds. `original`: its width "
        "is not printed and taken such that its size is as said, above 25 MB."
    )
    notes = [
        *([printed] if published else []),
        *_describe_errors(found),
        *(describe(profile) for profile in list(profiled.values())[:1]),
        *_without_errors(table, steps),
        *describe_trainings(records, labels),
        *describe_widths(widths_json),
        phrases.describe_run(run),
    ]
    heading = f"{title} ({PAPER}, 3.5)" if published else title
    write_twins(whole, cells, csv, md, title=heading, notes=notes, text_columns=2)


def steps_table(
    steps: Mapping[str, Mapping[str, Any]],
    profiles: Mapping[str, Mapping[str, Any]],
    found: pd.DataFrame | None,
) -> pd.DataFrame:
    """A row for each step, and for the errors of what learns nothing.

    Columns: `row`, `null` (see `nulls_in`), `network`, `precision`, `runtime` (ms of a frame on all of the machine's threads, or
    its GPU, see `run` and `device`), `share` of a matrix product's rate, `size` (MiB of weights and biases not
    counted), `error` (mean squared) and `error_off_edges` with the ends of their intervals, NaN of what is not
    trained. Times and errors are NaN, too, in a number format that the machine would emulate.
    """
    rows = []
    for name, step in steps.items():
        profile = profiles[step["network"]]
        timed = [one for one in profile["runs"] if one["precision"] == step["precision"]]
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
            row |= _errors(found, in_format(step["experiment"], step["precision"]))
        rows.append(row | {"null": None})
    for null in nulls_in(found) if found is not None else ():
        rows.append({"row": null, "null": null} | _errors(found, null))
    return pd.DataFrame(rows).reindex(columns=COLUMNS)


def _errors(found: pd.DataFrame, method: str) -> dict[str, float]:
    mine = found[found["method"] == method]
    errors = mean_with_interval(by_frame(mine, "mse"), "error")
    return errors | mean_with_interval(by_frame(mine, OFF_EDGES), "error_off_edges")


def _describe_errors(found: pd.DataFrame | None) -> list[str]:
    if found is None:
        return []
    frames = by_frame(found, "mse")
    units = describe_units([*frames.index.unique("scene")], len(frames))
    return [
        f"Errors: mean over test frames and all lights, in the step's format [{units}].",
        ABOUT_NULLS,
    ]


def _without_errors(table: pd.DataFrame, steps: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A note on the steps that are trained and yet have no error; none if all have one."""
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
    """What is printed: a number, or that it is above one."""
    numbers = number_cells(table[f"printed_{name}"], form)
    bounds = number_cells(table[f"printed_{name}_above"], f"> {form}")
    return [number or bound for number, bound in zip(numbers, bounds)]


if "snakemake" in globals():
    run_stage(snakemake, write)
