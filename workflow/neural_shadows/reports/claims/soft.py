"""Methods for soft shadows against each other: as they are, and against rays of equal time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.soft_method_names import is_network, rays_of
from neural_shadows.metrics.error_scale import error_of
from neural_shadows.metrics.intervals import FEWEST_VIEWS, two_way_interval
from neural_shadows.reports.claims.comparison import NAMES, Comparison, judged, unjudged
from neural_shadows.reports.claims.measured import Measured
from neural_shadows.reports.digits import short

# What values are multiplied by, as their names in `NAMES` say.
FACTORS = {"mse": 1e4, "l1": 100, "light_leak": 100, "false_shadow": 100}
OF_ALL_LIGHTS = "all lights"


@dataclass(frozen=True)
class SoftTable:
    """What a table of soft methods is made of.

    Args:
        values: a row a frame (scene, part, frame), a column a (method, metric, radius).
        labels: by method. times: what `time_soft_methods` wrote; None of what is not timed; radii: as
        they were given, with their unit.
    """

    values: pd.DataFrame
    labels: Mapping[str, str]
    times: Mapping[str, Any] | None
    radii: Sequence[str]

    def milliseconds(self, method: str, radius: int | None) -> float:
        """Of a frame, the map's making included; of no radius the mean over all; NaN of what is not
        timed.
        """
        timed = self.times["methods"].get(method) if self.times else None
        if timed is None:
            return float("nan")
        own = np.mean(timed["ms"]) if radius is None else timed["ms"][radius]
        return own + self.times["maps"].get(timed["map"], {"ms": 0.0})["ms"]

    def light(self, radius: int | None) -> str:
        """What a radius is called."""
        return OF_ALL_LIGHTS if radius is None else self.radii[radius]

    def errors(self, method: str, metric: str, radius: int | None) -> pd.Series | None:
        """Of each frame, less is better, SSIM as 1 − SSIM; None if it was not measured."""
        radii = range(len(self.radii)) if radius is None else [radius]
        columns = [(method, metric, k) for k in radii]
        if any(one not in self.values for one in columns):
            return None
        found = FACTORS.get(metric, 1) * self.values[columns].mean(axis=1, skipna=False)
        return found.map(partial(error_of, metric))


def soft_values(metrics: pd.DataFrame) -> pd.DataFrame:
    """The `values` of a `SoftTable`, from what `read_soft_metrics` reads."""
    index, columns = ["scene", "part", "frame"], ["method", "metric", "radius"]
    return metrics.pivot_table("value", index, columns)


def better(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each pair, metric and radius, see `_of_seeds`."""
    radii = claim["radii"] or [None]
    return [
        _of_seeds(claim, data, metric, radius, pair)
        for pair, metric, radius in product(claim["pairs"], claim["metrics"], radii)
    ]


def equal_time(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """The same of each method and the most rays that take no longer than it, of a network than its
    first seed.
    """
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
            found.append(_of_seeds(claim, data, "mse", radius, (rays, method)))
    return found


def _of_seeds(
    claim: Mapping[str, Any], data: Measured, metric: str, radius: int | None, pair: Sequence[str]
) -> Comparison:
    """Two methods by paired differences over frames and seeds.

    Frames say nothing of how trainings differ: of fewer seeds of a network than the claim needs (two,
    if it does not say) nothing is judged. Other seeds of a network are `again` of its name.
    """
    again, needed = claim.get("again") or {}, (claim.get("needs") or {}).get("seeds") or 2
    runs = [[method, *again.get(method, ())] for method in pair]
    seeds = min((len(one) for one in runs if is_network(one[0])), default=None)
    table = data.soft[claim["table"]]
    one = _compared(table, metric, radius, [some[:seeds] for some in runs], data.seed)
    if seeds is None or seeds >= needed or one.untested:
        return one
    why = f"{seeds} seed{'s' * (seeds > 1)} of {needed}"
    return replace(one, supports=False, against=1.0, untested=why)


def _compared(
    table: SoftTable, metric: str, radius: int | None, pair: Sequence[Sequence[str]], seed: int
) -> Comparison:
    """Of two methods, each by its runs: of as many seeds, or one that all are compared with."""
    names = [runs[0] for runs in pair]
    labels, light = [table.labels[name] for name in names], table.light(radius)
    kept = {"metric": metric, "methods": f"{' against '.join(labels)} at {light}"}
    errors = [[table.errors(run, metric, radius) for run in runs] for runs in pair]
    if missing := [label for label, some in zip(labels, errors) if any(x is None for x in some)]:
        told = f"no {NAMES[metric]} of {', '.join(missing)}"
        return Comparison(**kept, text=kept["methods"], **unjudged(untested=told))
    frames = [pd.concat(some, axis=1) for some in errors]
    means = [error_of(metric, one.mean(axis=None)) for one in frames]
    texts = [
        f"{label} {short(mean)}{_in_time(table.milliseconds(name, radius))}"
        for label, name, mean in zip(labels, names, means)
    ]
    kept["text"] = f"{NAMES[metric]} at {light} of {' against '.join(texts)}"
    first, second = (one.to_numpy() for one in frames)
    gain = pd.DataFrame(second - first, frames[0].index).dropna()  # one run stands beside several
    if len(gain) < FEWEST_VIEWS:
        return Comparison(**kept, **unjudged(untested=f"{len(gain)} frames are too few"))
    scenes = gain.index.get_level_values("scene").to_numpy()
    return Comparison(**kept, **judged(*two_way_interval(gain.to_numpy().T, seed, groups=scenes)))


def _in_time(milliseconds: float) -> str:
    return "" if np.isnan(milliseconds) else f" ({milliseconds:.0f} ms)"
