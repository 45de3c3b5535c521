"""Frame times, methods' own times, and bytes."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.reports.data.inputs import read_sizes
from neural_shadows.settings.records import FrameTimes, Row

FRAME_MS = ("frame_ms", "frame_ms_q1", "frame_ms_q3")  # median and quartiles, ms
OWN_MS = ("own_ms", "own_ms_q1", "own_ms_q3")
QUANTILES = (0.5, 0.25, 0.75)


def timing_table(
    times: Mapping[str, FrameTimes],
    rows: Sequence[Row],
    weights: Sequence[Path],
) -> pd.DataFrame:
    """Tabulate times and bytes by row; `times`: of `time_methods`, by scene.

    Columns `scene`, `method` (the label), `FRAME_MS`, `OWN_MS`, `repeats`, `device`,
    `stored_bytes`, `resident_bytes`: what a file of the method holds, and what is in memory while
    it answers. NaN where a column does not apply.
    """
    sizes, records = read_sizes(rows, weights), []
    for row in rows:
        timed = times[row["scene"]]["methods"][row["method"]]
        record = {"scene": row["scene"], "method": row["label"]}
        record |= dict(zip(FRAME_MS, np.quantile(timed["ms"], QUANTILES)))
        record |= dict(zip(OWN_MS, np.quantile(timed["own_ms"], QUANTILES)))
        record |= {"repeats": len(timed["ms"]), "device": timed["device"]}
        record["stored_bytes"] = sizes[row["method"]]
        record["resident_bytes"] = timed["resident_bytes"]
        records.append(record)
    names = ("scene", "method", *FRAME_MS, *OWN_MS, "repeats", "device")
    table = pd.DataFrame(records, columns=[*names, "stored_bytes", "resident_bytes"])
    return table.astype({"resident_bytes": float, "stored_bytes": float})


def devices(times: Mapping[str, FrameTimes]) -> list[str]:
    """The devices that the methods ran on, each once: times of several do not compare."""
    names = {method["device"] for one in times.values() for method in one["methods"].values()}
    return sorted(names)
