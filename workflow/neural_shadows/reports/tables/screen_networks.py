"""Multiply-adds and weights of screen-space networks (NSM, tables S4, S5)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.layout.layout import Layout
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.networks.screen_space.widths import total
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.published import printed_column, read_published
from neural_shadows.reports.data.table import Table, filled, numbers, write_table
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import NsmTable
from neural_shadows.settings.base import Model, Name, name_in, section_or
from neural_shadows.settings.records import Run


class NetworkRow(Model):
    """A row with its own settings."""

    network: name_in("screen_networks") = Field(description="a name in `screen_networks`")
    published: Name | None = Field(
        None, description="its row in published_nsm.csv, if not of `network`'s name"
    )


class Settings(NsmTable):
    """Multiply-adds and weights of several networks."""

    kind: Literal["screen_networks"] = Field(description="`screen_networks`")
    networks: list[section_or(NetworkRow, "network")] = Field(
        min_length=1, description="in the table's order"
    )


def files(layout: Layout, table: str) -> dict[str, Any]:
    return {"published_nsm_csv": layout.source("config/published_nsm.csv")}


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    rows = [
        {
            "name": row["network"],
            "published": row["published"] or row["network"],
            "settings": layout.entry("screen_networks", row["network"]),
        }
        for row in settings["networks"]
    ]
    return {"published": settings["published"], "networks": rows, "run": layout.run()}


def forms(layout: Layout, table: str) -> set[str]:
    rows = layout.entry("tables", table)["networks"]
    return {layout.entry("screen_networks", row["network"])["form"] for row in rows}


def table(
    *,
    published_nsm_csv: Path,
    title: str,
    published: str | None,
    networks: Sequence[Mapping[str, Any]],
    run: Run,
) -> Table:
    """Tabulate `network_table`."""
    printed_numbers = read_published(published_nsm_csv)
    table = network_table(networks, printed_numbers, published).assign(scale=run["scale"])
    shown = {
        "network": table["network"],
        "widths": table["widths"],
        "levels": [*map(str, table["levels"])],
        "multiply-adds a pixel": numbers(table["mac_per_pixel"], "{:,.0f}"),
        "printed": numbers(table["printed_mac_per_pixel"], "{:,.0f}"),
        "difference": numbers(table["mac_per_pixel_minus_printed"], "{:+.4g}"),
        "weights": numbers(table["parameters"], "{:,.0f}", 1000),
        "printed, thousands": numbers(table["printed_parameters"], "{:,.6g}"),
        "difference, thousands": numbers(table["parameters_minus_printed"], "{:+.2g}"),
        "MiB at 16 bits": numbers(table["mib"], "{:.2f}"),
    }
    notes = [
        "Of each network's convolutions, without biases. Widths: channels of each level from the "
        "finest, of both convolutions if they differ. Levels: from the frame's own size to the deepest.",
        phrases.describe_run(run),
    ]
    heading = phrases.titled(title, published)
    shown = filled(shown)
    return Table(heading, table, shown, notes, text_columns=2)


def network_table(
    networks: Sequence[Mapping[str, Any]], printed_numbers: pd.Series, published: str | None
) -> pd.DataFrame:
    """Tabulate multiply-adds and weights by network.

    `networks`: `name`, the row in the paper (`published`) and `settings` of each.

    Columns `network`, `widths`, `levels`, `mac_per_pixel`, `parameters` (thousands), both `printed_`
    and `_minus_printed`, `mib` of weights at 16 bits.
    """
    records = []
    for network in networks:
        settings = network["settings"]
        widths, layers = settings["widths"], layers_of(settings)
        records.append(
            {
                "network": network["name"],
                "widths": " ".join(str(width).replace(", ", "-").strip("[]") for width in widths),
                "levels": max(layer.level for layer in layers) + 1,
                "mac_per_pixel": total(layers, "macs"),
                "parameters": total(layers, "weights") / 1e3,
                "mib": 2 * total(layers, "weights") / 2**20,
            }
        )
    table, rows = pd.DataFrame(records), [network["published"] for network in networks]
    for name in ("mac_per_pixel", "parameters"):
        table[f"printed_{name}"] = printed_column(printed_numbers, published, rows, name)
        table[f"{name}_minus_printed"] = table[name] - table[f"printed_{name}"]
    return table


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
