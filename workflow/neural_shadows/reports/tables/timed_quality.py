"""Frame time, size and quality of methods, as the tables of timed methods share them."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.reports.inputs import by_folder, read_sizes
from neural_shadows.reports.tables.quality import quality_table

QUARTILES = ("frame_ms_q1", "frame_ms", "frame_ms_q3")


def timed_quality(
    times: Mapping[str, Mapping[str, Any]],
    metrics: Sequence[Path],
    weights: Sequence[Path],
    rows: Sequence[Mapping[str, Any]],
    seed: int,
) -> pd.DataFrame:
    """A row per method, those of a scene together.

    Columns `scene`, `method` (the label), `QUARTILES`, `repeats`, `bytes`, and those of
    `quality_table`; NaN where a column does not apply: a ray-traced frame is the reference itself.

    Args:
        times: what `measure_frame_times` wrote, by scene; seed: of the bootstrap.
    """
    sizes, files = read_sizes(rows, weights), by_folder(metrics)
    parts = []
    for scene, timed in times.items():
        here = [row for row in rows if row["scene"] == scene]
        known = []
        for row in here:
            ms, size = timed["methods"][row["method"]]["ms"], sizes.get(row["method"], np.nan)
            quartiles = dict(zip(QUARTILES, np.quantile(ms, (0.25, 0.5, 0.75))))
            names = {"scene": scene, "method": row["label"]}
            known.append({**names, **quartiles, "repeats": len(ms), "bytes": size})
        measured = [row for row in here if row["method"] != RAY_TRACED]
        quality = quality_table(read_metrics(files[scene]), measured, seed)
        parts.append(pd.DataFrame(known).merge(quality, on="method", how="left"))
    return pd.concat(parts, ignore_index=True)
