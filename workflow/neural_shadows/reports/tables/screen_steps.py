"""Steps from a large screen-space network to a fast one.

Datta et al. 2022, 3.5, figure 8; Hu et al. 2025, 4.2.1.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.registry import UNLEARNED, in_format
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import frame_methods, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.paths import ALL
from neural_shadows.layout.tables import unique
from neural_shadows.reports.data.frame_means import describe_sample, squared_errors
from neural_shadows.reports.data.phrases import TEXTS
from neural_shadows.reports.data.published import printed_column, read_published, with_printed
from neural_shadows.reports.data.screen_profiles import (
    describe,
    of_printed_size,
    product_share,
    run_name,
)
from neural_shadows.reports.data.soft_frames import ABOUT_NULLS, TrainedFrames, learned_rows
from neural_shadows.reports.data.table import (
    Table,
    filled,
    intervals,
    number_cells,
    numbers,
    with_ends,
)
from neural_shadows.sections.experiments import ScreenExperimentName
from neural_shadows.sections.frame_tables import FramesTable, OfAnyScenes
from neural_shadows.sections.networks import ScreenNetworkName
from neural_shadows.settings.base import Model, Name
from neural_shadows.settings.records import Profile

COLUMNS = (
    *("row", "null", "network", "precision", "run", "device", "runtime", "share", "size"),
    *(*with_ends("error"), *with_ends("error_off_edges")),
)
BYTES = {"float32": 4, "bfloat16": 2}


class Step(Model):
    """A step on the way to a fast network."""

    network: ScreenNetworkName = Field(description="a screen-space network of `networks`: timed")
    precision: Literal["float32", "bfloat16"] = Field(
        description="of its weights, its time and its error"
    )
    experiment: ScreenExperimentName | None = Field(
        None, description="an experiment on frames: its error, in this precision"
    )


class Settings(FramesTable):
    """From a large screen-space network to a fast one (Datta et al. 2022, 3.5)."""

    shown_in = "steps"

    published: Literal["nsm.steps"] | None = Field(
        None, description="`nsm.steps`, the paper's printed numbers"
    )
    kind: Literal["screen_steps"] = Field(description="`screen_steps`")
    over: OfAnyScenes = "all"
    steps: dict[Name, Step] = Field(min_length=1, description="by the paper's names, in order")

    def methods_shown(self) -> list[str]:
        return [step.experiment for step in self.steps.values() if step.experiment]


def files(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    steps, frame_set, paths = settings["steps"].values(), settings["frame_set"], layout.paths
    trained = [step for step in steps if step["experiment"]]
    keys = unique(in_format(step["experiment"], step["precision"]) for step in trained)
    experiments = unique(step["experiment"] for step in trained)
    nulls = UNLEARNED if trained else ()
    return {
        "soft_metrics": [paths.evaluation("csv", frame_set, key, ALL) for key in keys],
        "null_metrics": [paths.evaluation("csv", frame_set, key, ALL) for key in nulls],
        "screen_trainings": [paths.network("training.json", name) for name in experiments],
        "frames_json": [],
        "widths_json": tables.widths(layout, frame_set) if trained else [],
        "profiles": [paths.screen_profile(name) for name in unique(s["network"] for s in steps)],
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    steps = layout.entry("tables", table)["steps"].values()
    names = unique(step["experiment"] for step in steps if step["experiment"])
    labels = {name: frame_methods.label(layout, name) for name in names}
    return {"labels": labels, "measured": tables.shown_scenes(layout, table)}


def table(
    soft: TrainedFrames,
    profiles: list[Path],
    published_nsm_csv: Path,
    title: str,
    published: str | None,
    steps: Mapping[str, Mapping[str, Any]],
    measured: Sequence[str],
) -> Table:
    """Tabulate time, size and error by step, beside printed numbers.

    CSV: those of `steps_table`, printed numbers and differences, `of_printed_size`, whether frames are
    timed that have the paper's, and the scale.

    Args:
        soft: the steps' experiments in their number formats, without frames.
        profiles: of `profile_screen_network`, of the steps' networks.
        published: `nsm.steps`; None for steps that the paper does not print.
        steps: see `Step`, by its name in the paper.
        measured: the scenes whose frames count.
    """
    soft = soft.of_scenes(measured)
    profiled = {path.stem: read_json(path) for path in profiles}
    table = steps_table(steps, profiled, soft)
    printed_numbers = read_published(published_nsm_csv)
    table["of_printed_size"] = all(
        of_printed_size(profile, printed_numbers) for profile in profiled.values()
    )
    for name in ("runtime", "size", "error"):
        printed, above = (
            printed_column(printed_numbers, published, table["row"], column)
            for column in (name, f"{name}_above")
        )
        table = with_printed(table, name, printed).assign(**{f"printed_{name}_above": above})
    whole, table = table, learned_rows(table)
    cells = {
        "step": table["row"],
        "format": table["precision"],
        "ms": numbers(table["runtime"], "{:.1f}"),
        "printed": _printed(table, "runtime", "{:g}"),
        "share of the products' rate, %": numbers(table["share"], "{:.0f}", 100),
        "MiB": numbers(table["size"], "{:.2f}"),
        "printed, MB": _printed(table, "size", "{:g}"),
        "MSE × 10⁻³": intervals(table, with_ends("error"), 2, 1e3),
        "off edges × 10⁻³": numbers(table["error_off_edges"], "{:.2f}", 1e3),
        "printed × 10⁻³": numbers(table["printed_error"], "{:.2f}", 1e3),
    }
    printed = (
        f"Printed: {TEXTS['nsm']}, on an RTX 2080 Ti: milliseconds are of another "
        "machine. `original`: its width is not printed; ours gives the printed size, above 25 MB."
    )
    notes = [
        *([printed] if published else []),
        *_describe_errors(soft),
        *(describe(profile) for profile in list(profiled.values())[:1]),
        *_without_errors(table, steps),
        *soft.notes()[1:],
    ]
    heading = f"{title} ({TEXTS['nsm']}, 3.5)" if published else title
    return Table(whole, filled(cells), notes, heading, text_columns=2)


def steps_table(
    steps: Mapping[str, Mapping[str, Any]], profiles: Mapping[str, Profile], soft: TrainedFrames
) -> pd.DataFrame:
    """Tabulate time, size and error by step, and errors of null predictors.

    Columns: `row`, `null` (see `TrainedFrames.nulls`), `network`, `precision`, `runtime` (ms of a
    frame on `compute.timing_cores` threads, or a GPU, see `run` and `device`), `share` of a matrix
    product's rate, `size` (MiB of weights and biases not counted), `error` (mean squared) and
    `error_off_edges` with the ends of their intervals, NaN of what is not trained. Times and errors
    are NaN, too, in a number format that the machine would emulate.
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
        key = step["experiment"] and in_format(step["experiment"], step["precision"])
        rows.append(row | _errors(soft, key) | {"null": None})
    rows += [{"row": null, "null": null} | _errors(soft, null) for null in soft.nulls]
    return pd.DataFrame(rows).reindex(columns=COLUMNS)


def _errors(soft: TrainedFrames, method: str | None) -> dict[str, float]:
    if method is None:
        return {}
    return squared_errors(soft.errors[soft.errors["method"] == method], "error")


def _describe_errors(soft: TrainedFrames) -> list[str]:
    if not soft.soft_metrics:
        return []
    return [
        "Errors: mean over test frames and all lights, in the step's number format "
        f"[{describe_sample(soft.errors)}].",
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
