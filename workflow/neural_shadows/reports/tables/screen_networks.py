"""Networks of whole frames side by side: multiply-adds and weights (NSM, tables S4 and S5)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from neural_shadows.networks.screen_space.kernel_widths import layers_of
from neural_shadows.networks.screen_space.widths import total
from neural_shadows.reports import phrases
from neural_shadows.reports.published_nsm import printed, read_published_nsm, titled
from neural_shadows.reports.tables.writing import number_cells, write_twins
from neural_shadows.running.stage import run_stage


def write(
    *,
    published_nsm_csv: Path,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    networks: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
) -> None:
    """Write `network_table`."""
    numbers = read_published_nsm(published_nsm_csv)
    table = network_table(networks, numbers, published).assign(scale=run["scale"])
    shown = {
        "network": table["network"],
        "widths": table["widths"],
        "levels": [*map(str, table["levels"])],
        "multiply-adds a pixel": number_cells(table["mac_per_pixel"], "{:,.0f}"),
        "printed": number_cells(table["printed_mac_per_pixel"], "{:,.0f}"),
        "difference": number_cells(table["mac_per_pixel_minus_printed"], "{:+.4g}"),
        "weights": number_cells(table["parameters"], "{:,.0f}", 1000),
        "printed, thousands": number_cells(table["printed_parameters"], "{:,.6g}"),
        "difference, thousands": number_cells(table["parameters_minus_printed"], "{:+.2g}"),
        "MiB at 16 bits": number_cells(table["mib"], "{:.2f}"),
    }
    notes = [
        "Counted of each network's convolutions, without biases. Widths: channels of each level, from "
        "the finest; where its two convolutions differ, of both. Levels: with the frame's own size "
        "and the deepest.",
        phrases.describe_run(run),
    ]
    heading = titled(title, published)
    shown = {name: cells for name, cells in shown.items() if any(cells)}
    write_twins(table, shown, csv, md, title=heading, notes=notes, text_columns=2)


def network_table(
    networks: Sequence[Mapping[str, Any]], numbers: pd.Series, published: str | None
) -> pd.DataFrame:
    """A row for each network, of `name`, its row in the paper (`published`) and its `settings`.

    Columns `network`, `widths`, `levels`, `mac_per_pixel`, `parameters` (thousands), both `printed_`
    and `_minus_printed`, `mib` of weights at 16 bits.
    """
    records = []
    for one in networks:
        settings = one["settings"]
        widths, layers = settings["widths"], layers_of(settings)
        records.append(
            {
                "network": one["name"],
                "widths": " ".join(str(width).replace(", ", "-").strip("[]") for width in widths),
                "levels": max(layer.level for layer in layers) + 1,
                "mac_per_pixel": total(layers, "macs"),
                "parameters": total(layers, "weights") / 1e3,
                "mib": 2 * total(layers, "weights") / 2**20,
            }
        )
    table, rows = pd.DataFrame(records), [one["published"] for one in networks]
    for name in ("mac_per_pixel", "parameters"):
        table[f"printed_{name}"] = printed(numbers, published, rows, name)
        table[f"{name}_minus_printed"] = table[name] - table[f"printed_{name}"]
    return table


if "snakemake" in globals():
    run_stage(snakemake, write)
