"""Methods for soft shadows against each other: as they are, and against rays of equal time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd

from neural_shadows.evaluation.soft_method_names import is_network, rays_of
from neural_shadows.metrics.intervals import FEWEST_VIEWS, two_way_interval
from neural_shadows.reports.claims.comparison import NAMES, Comparison, judged, unjudged
from neural_shadows.reports.claims.measured import Measured

# What values are multiplied by, as their names in `NAMES` say.
FACTORS = {"mse": 1e4, "l1": 100, "light_leak": 100, "false_shadow": 100}


@dataclass(frozen=True)
class SoftTable:
    """What a table of soft methods is made of.

    Args:
        values: a row a frame (scene, part, frame), a column a (method, metric, radius).
        labels: by method. times: what `time_soft_methods` wrote; radii: as they were given, with
        their unit.
    """

    values: pd.DataFrame
    labels: Mapping[str, str]
    times: Mapping[str, Any]
    radii: Sequence[str]

    def milliseconds(self, method: str, radius: int) -> float:
        """Of a frame, the map's making included; NaN of what is not timed."""
        timed = self.times["methods"].get(method)
        if timed is None:
            return float("nan")
        return timed["ms"][radius] + self.times["map_ms"] * (timed["texel_floats"] > 0)


def soft_values(metrics: pd.DataFrame) -> pd.DataFrame:
    """The `values` of a `SoftTable`, from what `read_soft_metrics` reads."""
    index, columns = ["scene", "part", "frame"], ["method", "metric", "radius"]
    return metrics.pivot_table("value", index, columns)


def better(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each pair and radius, by paired differences over frames.

    Frames say nothing of how trainings differ: of a network's one training nothing is judged.
    """
    table = data.soft[claim["table"]]
    found = []
    for pair in claim["pairs"]:
        for radius in claim["radii"]:
            one = _compared(table, claim["metric"], radius, pair, data.seed)
            if not one.untested and any(map(is_network, pair)):
                why = f"1 seed of {(claim.get('needs') or {}).get('seeds') or 2}"
                one = replace(one, supports=False, against=1.0, untested=why)
            found.append(one)
    return found


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
                if rays_of(name) and table.milliseconds(name, radius) <= limit
            ]
            rays = max(counts, key=rays_of, default=None)
            if rays is None:
                text = f"{table.labels[method]} takes {limit:.1f} ms at {table.radii[radius]}"
                why = unjudged(untested=f"no number of rays fits into {limit:.1f} ms")
                found.append(Comparison("mse", table.labels[method], text, **why))
                continue
            one = _compared(table, "mse", radius, (rays, method), data.seed)
            found.append(one)
    return found


def _compared(
    table: SoftTable, metric: str, radius: int, pair: Sequence[str], seed: int
) -> Comparison:
    factor, labels = FACTORS.get(metric, 1), [table.labels[method] for method in pair]
    kept = {
        "metric": metric,
        "methods": f"{' against '.join(labels)} at {table.radii[radius]}",
    }
    columns = [(method, metric, radius) for method in pair]
    if missing := [one for one in columns if one not in table.values]:
        told = f"no {NAMES[metric]} of {', '.join(table.labels[one[0]] for one in missing)}"
        return Comparison(**kept, text=kept["methods"], **unjudged(untested=told))
    values = [factor * table.values[one] for one in columns]
    texts = [
        f"{label} {one.mean():.3g} ({table.milliseconds(method, radius):.0f} ms)"
        for label, one, method in zip(labels, values, pair)
    ]
    gain = (values[1] - values[0]).dropna()
    kept["text"] = f"{NAMES[metric]} at {table.radii[radius]} of {' against '.join(texts)}"
    if len(gain) < FEWEST_VIEWS:
        return Comparison(**kept, **unjudged(untested=f"{len(gain)} frames are too few"))
    scenes = gain.index.get_level_values("scene").to_numpy()
    return Comparison(
        **kept, **judged(*two_way_interval(gain.to_numpy()[None], seed, groups=scenes))
    )
