"""Time of a screen-space network by level and part (NSM, table S3)."""

from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.data import screen_profiles
from neural_shadows.reports.data.published import printed_column, read_published, with_printed
from neural_shadows.reports.data.table import Table, filled, numbers
from neural_shadows.sections.frame_tables import ProfileTable
from neural_shadows.settings.records import Profile

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


def table(profile_json: Path, published_nsm_csv: Path, published: str | None) -> Table:
    """Tabulate `part_table`; `profile_json`: of `profile_screen_network`."""
    profile, printed_numbers = read_json(profile_json), read_published(published_nsm_csv)
    table = part_table(profile, printed_numbers, published)
    shown = {
        "level": [*map(str, table["level"])],
        "part": [NAMES.get(part, part) for part in table["part"]],
    }
    shown |= screen_profiles.run_columns(profile, table)
    shown["%"] = numbers(table["share"], "{:.1f}", 100)
    shown["printed ms"] = numbers(table["printed_ms"], "{:.2f}")
    shown["printed %"] = numbers(table["printed_share"], "{:.1f}", 100)
    shown["difference, ms"] = numbers(table["ms_minus_printed"], "{:+.3g}")
    compared = screen_profiles.run_name(screen_profiles.compared(profile))
    notes = [
        f"%: of all parts, {compared}; printed times stand beside these. Convolutions include their "
        "padding and activations. The paper's text has no skip at level 0, but its table times one.",
        screen_profiles.describe(profile),
        screen_profiles.describe_printed_times(profile, printed_numbers),
    ]
    return Table(table, filled(shown), notes, text_columns=2)


def part_table(profile: Profile, printed_numbers: pd.Series, published: str | None) -> pd.DataFrame:
    """Tabulate times by level and part, measured or printed.

    Columns `level`, `part`, `ms_RUN` of each run, `run`, the name of the compared one, its `ms` and
    their `share` of all parts, `printed_ms`, `printed_share`, `ms_minus_printed` (in frames of the
    paper's size).
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
    rows = [f"level_{level}" for level in table["level"]]
    columns = [PRINTED.get(part, "") for part in table["part"]]
    printed = printed_column(printed_numbers, published, rows, columns)
    table["printed_ms"] = printed
    table["printed_share"] = printed / np.nansum(printed)
    same = screen_profiles.of_printed_size(profile, printed_numbers)
    return with_printed(table, "ms", printed, comparable=same)
