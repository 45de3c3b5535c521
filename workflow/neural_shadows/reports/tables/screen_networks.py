"""Multiply-adds and weights of screen-space networks (NSM, tables S4, S5)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, TypedDict

import pandas as pd
from pydantic import Field

from neural_shadows.layout.layout import Layout
from neural_shadows.networks.kind_module import form_module
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.networks.screen_space.widths import total
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.reports.data.published import printed_column, read_published, with_printed
from neural_shadows.reports.data.table import Table, filled, numbers
from neural_shadows.sections.frame_tables import NsmTable
from neural_shadows.sections.networks import ScreenNetworkName
from neural_shadows.settings.base import Model, Name, section_or


class Network(TypedDict):
    """A network in the table's order."""

    name: str
    published: str  # its row in the paper
    settings: Mapping[str, Any]  # its entry


class NetworkRow(Model):
    """A row with its own settings."""

    network: ScreenNetworkName = Field(description="a screen-space network of `networks`")
    published: Name | None = Field(
        None, description="its row in published_nsm.csv, if not of `network`'s name"
    )


class Settings(NsmTable):
    """Multiply-adds and weights of several networks."""

    kind: Literal["screen_networks"] = Field(description="`screen_networks`")
    networks: list[section_or(NetworkRow, "network")] = Field(
        min_length=1, description="in the table's order"
    )


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    rows = [
        {
            "name": row["network"],
            "published": row["published"] or row["network"],
            "settings": layout.entry("networks", row["network"]),
        }
        for row in settings["networks"]
    ]
    return {"networks": rows}


def modules(layout: Layout, table: str) -> set[Path]:
    rows = layout.entry("tables", table)["networks"]
    return {form_module(layout.entry("networks", row["network"])["form"]) for row in rows}


def table(published_nsm_csv: Path, published: str | None, networks: Sequence[Network]) -> Table:
    """Tabulate `network_table`."""
    printed_numbers = read_published(published_nsm_csv)
    table = network_table(networks, printed_numbers, published)
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
    ]
    return Table(table, filled(shown), notes, text_columns=2)


def network_table(
    networks: Sequence[Network], printed_numbers: pd.Series, published: str | None
) -> pd.DataFrame:
    """Tabulate multiply-adds and weights by network.

    Columns `network`, `widths`, `levels`, `mac_per_pixel`, `parameters` (thousands), both `printed_`
    and `_minus_printed`, `mib` of weights at 16 bits.
    """
    records = []
    for network in networks:
        settings = screen_network(network["settings"])
        widths, layers = settings.widths, layers_of(settings)
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
        printed = printed_column(printed_numbers, published, rows, name)
        table = with_printed(table, name, printed)
    return table
