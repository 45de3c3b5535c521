"""Memory of networks and shadow maps [4.4.2, table 4.7]."""

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.reports.data.inputs import read_sizes
from neural_shadows.reports.data.published import add_printed
from neural_shadows.reports.data.table import Table, numbers
from neural_shadows.sections.rows import TableOfOneScene
from neural_shadows.settings.records import Row


class Settings(TableOfOneScene):
    """The memory that methods take [4.4.2]."""

    kind: Literal["memory"] = Field(description="`memory`")


def table(
    weights: list[Path], published_csv: Path, published: str | None, rows: Sequence[Row]
) -> Table:
    """Tabulate the bytes of each method beside the thesis's numbers."""
    sizes = read_sizes(rows, weights)
    table = pd.DataFrame({"method": row["label"], "bytes": sizes[row["method"]]} for row in rows)
    table.insert(1, "memory_mib", table["bytes"] / 2**20)
    table = add_printed(table, rows, ["memory_mib"], published, published_csv, meshes={})
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
    ]
    return Table(table, columns, notes)
