"""Memory of networks and shadow maps [4.4.2, table 4.7]."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import experiments_of, networks
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.inputs import read_sizes
from neural_shadows.reports.data.published import add_printed
from neural_shadows.reports.data.table import Table, numbers, write_table
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.rows import TableOfOneScene
from neural_shadows.settings.records import Row, Run


class Settings(TableOfOneScene):
    """The memory that methods take [4.4.2]."""

    kind: Literal["memory"] = Field(description="`memory`")


def files(layout: Layout, table: str) -> dict[str, Any]:
    rows = layout.entry("tables", table)["rows"]
    return {
        "weights": networks(layout, rows, "weights.safetensors"),
        "published_csv": layout.source("config/published.csv"),
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    settings = layout.entry("tables", table)
    return {"published": settings["published"], "rows": settings["rows"], "run": layout.run()}


def encodings(layout: Layout, table: str) -> set[str]:
    return layout.encodings(experiments_of(layout.entry("tables", table)["rows"]))


def table(
    *,
    weights: list[Path],
    published_csv: Path,
    title: str,
    published: str | None,
    rows: Sequence[Row],
    run: Run,
) -> Table:
    """Tabulate the bytes of each method beside the thesis's numbers."""
    sizes = read_sizes(rows, weights)
    table = pd.DataFrame({"method": row["label"], "bytes": sizes[row["method"]]} for row in rows)
    table.insert(1, "memory_mib", table["bytes"] / 2**20)
    table = add_printed(table, rows, ["memory_mib"], published, published_csv, meshes={})
    table = table.assign(scale=run["scale"])
    table = table.sort_values("bytes", ascending=False, kind="stable")
    columns = {
        "method": table["method"],
        "memory MiB": numbers(table["memory_mib"], "{:.4g}"),
        "thesis MiB": numbers(table["thesis_memory_mib"], "{:.4g}", printed_of="memory MiB"),
        "bytes": numbers(table["bytes"], "{:,.0f}"),
    }
    notes = [
        "A network: bytes of its weight file, 4 for each weight of the thesis's network. A shadow "
        "map of N² texels: 4 N² bytes, 2 N² with 16 bits.",
        phrases.describe_run(run),
    ]
    return Table(phrases.titled(title, published), table, columns, notes)


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
