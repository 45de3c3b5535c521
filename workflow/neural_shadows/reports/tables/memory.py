"""Memory of networks and shadow maps [4.4.2, table 4.7]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import read_sizes
from neural_shadows.reports.published import add_printed
from neural_shadows.reports.tables.writing import number_cells, write_twins
from neural_shadows.running.stage import run_stage


def write(
    *,
    weights: list[Path],
    published_csv: Path,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    rows: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
) -> None:
    """Write the bytes of each method beside the thesis's numbers, which stand beside any mesh."""
    sizes = read_sizes(rows, weights)
    table = pd.DataFrame({"method": row["label"], "bytes": sizes[row["method"]]} for row in rows)
    table.insert(1, "memory_mib", table["bytes"] / 2**20)
    table = add_printed(table, rows, ["memory_mib"], published, published_csv, meshes={})
    table = table.assign(scale=run["scale"])
    table = table.sort_values("bytes", ascending=False, kind="stable")
    columns = {
        "method": table["method"],
        "memory MiB": number_cells(table["memory_mib"], "{:.4g}"),
        "thesis MiB": number_cells(table["thesis_memory_mib"], "{:.4g}"),
        "bytes": number_cells(table["bytes"], "{:,}"),
    }
    notes = [
        "A network: what its weight file stores, 4 bytes for each weight of the thesis's. A shadow "
        "map of N² texels: 4 N² bytes, of 16 bit 2 N².",
        phrases.describe_run(run),
    ]
    write_twins(table, columns, csv, md, title=phrases.titled(title, published), notes=notes)


if "snakemake" in globals():
    run_stage(snakemake, write)
