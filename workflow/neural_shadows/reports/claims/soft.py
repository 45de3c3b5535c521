"""Methods for soft shadows against each other: as they are, and against rays of equal time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.metrics.intervals import FEWEST_VIEWS, two_way_interval
from neural_shadows.reports.claims.comparison import NAMES, Comparison, judged, unjudged
from neural_shadows.reports.claims.measured import Measured

# What values are multiplied by, as their names in `NAMES` say.
FACTORS = {"mse": 1e4, "l1": 100, "light_leak": 100, "false_shadow": 100}
RAYS = "rt_"


@dataclass(frozen=True)
class SoftTable:
    """What a table of soft methods is made of.

    Args:
        values: a row a frame (scene, part, frame), a column a (method, metric, radius).
        labels: by method. times: what `time_soft_methods` wrote.
    """

    values: pd.DataFrame
    labels: Mapping[str, str]
    times: Mapping[str, Any]

    def milliseconds(self, method: str, radius: int) -> float:
        """Of a frame, the map's making included."""
        timed = self.times["methods"][method]
        return timed["ms"][radius] + self.times["map_ms"] * (timed["texel_floats"] > 0)


def soft_values(metrics: pd.DataFrame) -> pd.DataFrame:
    """The `values` of a `SoftTable`, from what `read_soft_metrics` reads."""
    index, columns = ["scene", "part", "frame"], ["method", "metric", "radius"]
    return metrics.pivot_table("value", index, columns)


def better(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each pair and radius, by paired differences over frames."""
    table = data.soft[claim["table"]]
    return [
        _compared(table, claim["metric"], radius, pair, data.seed)
        for pair in claim["pairs"]
        for radius in claim["radii"]
    ]


def equal_time(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """The same of each method and the most rays that take no longer than it."""
    table = data.soft[claim["table"]]
    found = []
    for method in claim["methods"]:
        for radius in claim["radii"]:
            limit = table.milliseconds(method, radius)
            counts = [
                name
                for name in table.labels
                if name.removeprefix(RAYS).isdecimal() and table.milliseconds(name, radius) <= limit
            ]
            rays = max(counts, key=lambda name: int(name.removeprefix(RAYS)), default=None)
            if rays is None:
                text = f"{table.labels[method]} takes {limit:.1f} ms at {_radius(table, radius)}"
                why = unjudged(untested=f"no number of rays fits into {limit:.1f} ms")
                found.append(Comparison("mse", table.labels[method], text, **why))
                continue
            one = _compared(table, "mse", radius, (rays, method), data.seed)
            found.append(one)
    return found


def _compared(
    table: SoftTable, metric: str, radius: int, pair: Sequence[str], seed: int
) -> Comparison:
    factor = FACTORS.get(metric, 1)
    values = [factor * table.values[method, metric, radius] for method in pair]
    labels = [table.labels[method] for method in pair]
    texts = [
        f"{label} {one.mean():.3g} ({table.milliseconds(method, radius):.0f} ms)"
        for label, one, method in zip(labels, values, pair)
    ]
    gain = (values[1] - values[0]).dropna().to_numpy()
    kept = {
        "metric": metric,
        "methods": f"{' against '.join(labels)} at {_radius(table, radius)}",
        "text": f"{NAMES[metric]} at {_radius(table, radius)} of {' against '.join(texts)}",
    }
    if len(gain) < FEWEST_VIEWS:
        return Comparison(**kept, **unjudged(untested=f"{len(gain)} frames are too few"))
    return Comparison(**kept, **judged(*two_way_interval(np.array([gain]), seed)))


def _radius(table: SoftTable, radius: int) -> str:
    return f"{table.times['radii'][radius]:.3g} m"
