"""Time of a screen-space network by level and part (NSM, table S3)."""

from functools import partial
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data import phrases, screen_profiles
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.published import (
    describe_printed_times,
    printed_column,
    printed_size,
    read_published,
)
from neural_shadows.reports.data.table import Table, filled, numbers, write_table
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import ProfileTable
from neural_shadows.settings.records import Run

# The paper's names of `ShadowUnet.parts`.
PRINTED = {
    "encoder": "encoder_convolution",
    "downsample": "downsample",
    "upsample": "upsample",
    "skip": "skip",
    "decoder": "decoder_convolution",
}
NAMES = {"encoder": "convolutions down", "decoder": "convolutions up"}


class Settings(ProfileTable):
    """The time of each level and part of a screen-space network."""

    kind: Literal["screen_parts"] = Field(description="`screen_parts`")


def files(layout: Layout, table: str) -> dict[str, Any]:
    return {
        "profile_json": layout.paths.screen_profile(layout.entry("tables", table)["network"]),
        "published_nsm_csv": layout.source("config/published_nsm.csv"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    return {"published": layout.entry("tables", table)["published"], "run": layout.run()}


def table(
    *,
    profile_json: Path,
    published_nsm_csv: Path,
    title: str,
    published: str | None,
    run: Run,
) -> Table:
    """Tabulate `part_table`; `profile_json`: of `profile_screen_network`.

    Raises:
        InputError: a file is missing or damaged.
    """
    profile, printed_numbers = read_json(profile_json), read_published(published_nsm_csv)
    table = part_table(profile, printed_numbers, published).assign(scale=run["scale"])
    shown = {
        "level": [*map(str, table["level"])],
        "part": [NAMES.get(part, part) for part in table["part"]],
    }
    for run_record in profile["runs"]:
        key = screen_profiles.run_key(run_record)
        shown[f"ms, {screen_profiles.run_name(run_record)}"] = numbers(
            table[f"ms_{key}"], partial(short, digits=4)
        )
    shown["%"] = numbers(table["share"], "{:.1f}", 100)
    shown["printed ms"] = numbers(table["printed_ms"], "{:.2f}")
    shown["printed %"] = numbers(table["printed_share"], "{:.1f}", 100)
    shown["difference, ms"] = numbers(table["ms_minus_printed"], "{:+.3g}")
    compared = screen_profiles.run_name(screen_profiles.compared(profile))
    notes = [
        f"%: of all parts, {compared}; printed times stand beside these. Convolutions include their "
        "padding and activations. The paper's text has no skip at level 0, but its table times one.",
        screen_profiles.describe(profile),
        describe_printed_times(profile, printed_numbers),
        phrases.describe_run(run),
    ]
    shown = filled(shown)
    heading = phrases.titled(title, published)
    return Table(heading, table, shown, notes, text_columns=2)


def part_table(
    profile: screen_profiles.Profile, printed_numbers: pd.Series, published: str | None
) -> pd.DataFrame:
    """Tabulate times by level and part, measured or printed.

    Columns `level`, `part`, `ms_RUN` of each run, `run`, the name of the compared one, its
    `ms` and their `share` of all parts, `printed_ms`, `printed_share`, `ms_minus_printed` (in frames of the paper's size).
    """
    times = screen_profiles.part_times(profile)
    names = {
        (f"level_{level['level']}", part): level["level"]
        for level in profile["levels"]
        for part in PRINTED
    }
    printed_parts = [
        (level, part)
        for (row, part), level in names.items()
        if (level, part) in times.index or (published, row, PRINTED[part]) in printed_numbers.index
    ]
    ends = [key for key in times.index if key not in printed_parts]
    times = times.reindex(
        pd.MultiIndex.from_tuples([*ends, *printed_parts], names=["level", "part"])
    )
    table = times.add_prefix("ms_").reset_index()
    run = screen_profiles.compared(profile)
    table["run"] = screen_profiles.run_name(run)
    table["ms"] = table[f"ms_{screen_profiles.run_key(run)}"]
    table["share"] = table["ms"] / table["ms"].sum()
    table["printed_ms"] = [
        printed_column(printed_numbers, published, [f"level_{level}"], PRINTED.get(part, ""))[0]
        for level, part in zip(table["level"], table["part"])
    ]
    table["printed_share"] = table["printed_ms"] / table["printed_ms"].sum()
    same = (profile["width"], profile["height"]) == printed_size(printed_numbers)
    table["ms_minus_printed"] = table["ms"] - table["printed_ms"] if same else np.nan
    return table


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
