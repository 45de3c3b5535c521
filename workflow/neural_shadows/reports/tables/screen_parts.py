"""The time of a network of whole frames by level and part (NSM, table S3)."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases, screen_profiles
from neural_shadows.reports.digits import short
from neural_shadows.reports.published_nsm import (
    beside,
    printed,
    printed_size,
    read_published_nsm,
    titled,
)
from neural_shadows.reports.tables.writing import number_cells, write_twins
from neural_shadows.running.stage import run_stage

# What the paper calls the parts of `ShadowUnet.parts`.
PRINTED = {
    "encoder": "encoder_convolution",
    "downsample": "downsample",
    "upsample": "upsample",
    "skip": "skip",
    "decoder": "decoder_convolution",
}
NAMES = {"encoder": "convolutions down", "decoder": "convolutions up"}


def write(
    *,
    profile_json: Path,
    published_nsm_csv: Path,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    run: Mapping[str, Any],
) -> None:
    """Write `part_table`; `profile_json`: what `profile_screen_network` wrote.

    Raises:
        InputError: a file is missing or damaged.
    """
    profile, numbers = read_json(profile_json), read_published_nsm(published_nsm_csv)
    table = part_table(profile, numbers, published).assign(scale=run["scale"])
    shown = {
        "level": [*map(str, table["level"])],
        "part": [NAMES.get(part, part) for part in table["part"]],
    }
    for one in profile["runs"]:
        key = screen_profiles.run_key(one)
        shown[f"ms, {screen_profiles.run_name(one)}"] = number_cells(
            table[f"ms_{key}"], partial(short, digits=4)
        )
    shown["%"] = number_cells(table["share"], "{:.1f}", 100)
    shown["printed ms"] = number_cells(table["printed_ms"], "{:.2f}")
    shown["printed %"] = number_cells(table["printed_share"], "{:.1f}", 100)
    shown["difference, ms"] = number_cells(table["ms_minus_printed"], "{:+.3g}")
    compared = screen_profiles.run_name(screen_profiles.compared(profile))
    notes = [
        f"%: of all parts, {compared}, which printed times stand beside. Convolutions with their "
        "padding and activations. The paper's text has no skip at level 0, which its table times.",
        screen_profiles.describe(profile),
        beside(profile, numbers),
        phrases.describe_run(run),
    ]
    shown = {name: cells for name, cells in shown.items() if any(cells)}
    heading = titled(title, published)
    write_twins(table, shown, csv, md, title=heading, notes=notes, text_columns=2)


def part_table(
    profile: screen_profiles.Profile, numbers: pd.Series, published: str | None
) -> pd.DataFrame:
    """A row for each level and part that is ours or printed.

    Columns `level`, `part`, `ms_RUN` of each run, `run`, what the one that is compared is called, its
    `ms` and their `share` of all parts, `printed_ms`, `printed_share`, `ms_minus_printed` (in frames of the paper's size).
    """
    times = screen_profiles.part_times(profile)
    names = {
        (f"level_{level['level']}", part): level["level"]
        for level in profile["levels"]
        for part in PRINTED
    }
    places = [
        (level, part)
        for (row, part), level in names.items()
        if (level, part) in times.index or (published, row, PRINTED[part]) in numbers.index
    ]
    ends = [place for place in times.index if place not in places]
    times = times.reindex(pd.MultiIndex.from_tuples([*ends, *places], names=["level", "part"]))
    table = times.add_prefix("ms_").reset_index()
    run = screen_profiles.compared(profile)
    table["run"] = screen_profiles.run_name(run)
    table["ms"] = table[f"ms_{screen_profiles.run_key(run)}"]
    table["share"] = table["ms"] / table["ms"].sum()
    table["printed_ms"] = [
        printed(numbers, published, [f"level_{level}"], PRINTED.get(part, ""))[0]
        for level, part in zip(table["level"], table["part"])
    ]
    table["printed_share"] = table["printed_ms"] / table["printed_ms"].sum()
    same = (profile["width"], profile["height"]) == printed_size(numbers)
    table["ms_minus_printed"] = table["ms"] - table["printed_ms"] if same else np.nan
    return table


if "snakemake" in globals():
    run_stage(snakemake, write)
