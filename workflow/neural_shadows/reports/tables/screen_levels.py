"""Costs of a screen-space network by level (NSM, table S2)."""

from pathlib import Path
from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.data import screen_profiles
from neural_shadows.reports.data.published import printed_column, read_published, with_printed
from neural_shadows.reports.data.table import Table, filled, numbers
from neural_shadows.sections.frame_tables import ProfileTable
from neural_shadows.settings.records import Profile

# Column, its unit, and the digits that the paper prints.
COLUMNS = {
    "runtime": ("ms", "{:.4g}"),
    "compute": ("GMAC", "{:.4g}"),
    "parameters": ("thousand weights", "{:.2f}"),
    "storage_io": ("million numbers", "{:.4g}"),
}
OF_ANY_SIZE = ("parameters",)


class Settings(ProfileTable):
    """Time, multiply-adds, weights and storage of each level of a screen-space network."""

    kind: Literal["screen_levels"] = Field(description="`screen_levels`")


def table(profile_json: Path, published_nsm_csv: Path, published: str | None) -> Table:
    """Tabulate `level_table`; `profile_json`: of `profile_screen_network`."""
    profile, printed_numbers = read_json(profile_json), read_published(published_nsm_csv)
    table = level_table(profile, printed_numbers, published)
    shown = {"level": [*map(str, table["level"])]}
    shown |= screen_profiles.run_columns(profile, table)
    shown["% of the product's rate"] = numbers(table["product_share"], "{:.0f}", 100)
    for name, (unit, form) in COLUMNS.items():
        if name != "runtime":
            shown[unit] = numbers(table[name], form)
        shown[f"printed {unit}"] = numbers(table[f"printed_{name}"], "{:.6g}")
        shown[f"difference, {unit}"] = numbers(table[f"{name}_minus_printed"], "{:+.3g}")
    compared = screen_profiles.run_name(screen_profiles.compared(profile))
    notes = [
        f"Printed times and rates stand beside those of {compared}. A level's rate: the multiply-adds "
        "of its convolutions over its whole time.",
        "Weights without biases, each multiply-add once. Storage: channels read and written by each "
        "convolution, over all pixels.",
        screen_profiles.describe(profile),
        screen_profiles.describe_printed_times(profile, printed_numbers),
    ]
    return Table(table, filled(shown), notes)


def level_table(
    profile: Profile, printed_numbers: pd.Series, published: str | None
) -> pd.DataFrame:
    """Tabulate costs by level.

    Columns `level`, `of_printed_size`, true for frames of the paper's size, `ms_RUN` of each run,
    and of `COLUMNS` ours, `printed_`, `_minus_printed` (of times, multiply-adds and storage in
    frames of the paper's size alone), `product_share`; `device`, whose time `runtime` is.
    """
    levels = pd.DataFrame(profile["levels"])
    times = screen_profiles.part_times(profile).groupby("level").sum()
    run = screen_profiles.compared(profile)
    pixels = profile["width"] * profile["height"]
    table = pd.DataFrame({"level": levels["level"]})
    for key in times:
        table[f"ms_{key}"] = times[key].reindex(table["level"]).to_numpy()
    table["runtime"] = table[f"ms_{screen_profiles.run_key(run)}"]
    table["device"] = run["device"]
    table["compute"] = levels["macs"] * pixels / 1e9
    table["parameters"] = levels["weights"] / 1e3
    table["storage_io"] = levels["storage"] * pixels / 1e6
    rate = 1e12 * table["compute"] / table["runtime"]
    table["product_share"] = rate / run["product_macs"]
    same = screen_profiles.of_printed_size(profile, printed_numbers)
    table["of_printed_size"] = same
    rows = [f"level_{level}" for level in table["level"]]
    for name in COLUMNS:
        printed = printed_column(printed_numbers, published, rows, name)
        table = with_printed(table, name, printed, comparable=same or name in OF_ANY_SIZE)
    return table
