"""How the cost of each stage grows, as a table."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases
from neural_shadows.reports.digits import short
from neural_shadows.reports.tables.writing import number_cells, write_twins
from neural_shadows.running.stage import run_stage

MIB = 2**20
SLOPE_POINTS = 3  # the largest sizes, where what a stage does at any size weighs least


def write(*, costs: list[Path], csv: Path, md: Path, title: str, run: Mapping[str, Any]) -> None:
    """Write the table of `cost_table`; `costs`: what `measure_cost` wrote, a file for each size."""
    measured = [read_json(path) for path in costs]
    table = cost_table(measured)
    columns = {
        "stage": table["stage"],
        "over": table["over"],
        "size": [f"{size:,}" for size in table["size"]],
        "seconds": number_cells(table["seconds"], short),
        "memory MiB": number_cells(table["memory_mib"], "{:,.0f}"),
        "exponent of seconds": number_cells(table["seconds_exponent"], "{:.2f}"),
        "exponent of memory": number_cells(table["memory_mib_exponent"], "{:.2f}"),
    }
    machine, threads = measured[0]["machine"], measured[0]["threads"]
    notes = [
        "Measured on a waved sphere. Where another size varies: 81,920 triangles, 1,000,000 "
        "samples, width 256, 4 viewpoints of 600 × 400. Training takes 200 steps of 1,024 samples, "
        "however many there are; an evaluation has one 512² map and one network, without LPIPS.",
        "Memory: peak resident memory above what the process held once its libraries were loaded. "
        "Rays are files mapped into memory (20 bytes a sample): their pages count here, but are "
        f"the first that a full machine frees. Exponents: of the {SLOPE_POINTS} largest sizes, 1 "
        "is linear.",
        f"Each measured once on {machine['cpu']}, {threads} threads, an evaluation on one.",
        phrases.describe_run(run),
    ]
    write_twins(table, columns, csv, md, title=title, notes=notes)


def cost_table(measured: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """A row for each stage and size: seconds, memory in MiB, and the exponents of both."""
    table = pd.json_normalize(measured, "stages", ["over", "size"])
    table = table.astype({"size": int}).sort_values(["over", "stage", "size"], ignore_index=True)
    table["memory_mib"], table["peak_mib"] = table["bytes"] / MIB, table["peak_bytes"] / MIB
    table = table[["stage", "over", "size", "seconds", "memory_mib", "peak_mib"]]
    for _, rows in table.groupby(["over", "stage"]):
        for column in ("seconds", "memory_mib"):
            exponent = growth(rows["size"].to_numpy(), rows[column].to_numpy())
            table.loc[rows.index, f"{column}_exponent"] = exponent
    return table


def growth(sizes: np.ndarray, values: np.ndarray) -> float:
    """Exponent b of value = a · size^b over the largest sizes: 1 is linear. NaN for one size."""
    order = np.argsort(sizes)[-SLOPE_POINTS:]
    positive = order[values[order] > 0]
    if len(positive) < 2:
        return np.nan
    return float(np.polyfit(np.log(sizes[positive]), np.log(values[positive]), 1)[0])


if "snakemake" in globals():
    run_stage(snakemake, write)
