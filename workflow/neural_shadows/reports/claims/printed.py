"""Claims that the thesis's own tables decide, without any training of ours."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from neural_shadows.metrics.equivalent_resolution import equivalent_resolution
from neural_shadows.metrics.error_scale import error_of
from neural_shadows.reports.claims.comparison import NAMES, Comparison
from neural_shadows.reports.claims.measured import Measured
from neural_shadows.reports.learned import HIGHER_IS_BETTER

MAP = "shadow_map_"
COUNTS_FROM = 2  # times the difference from run to run, which is known of two trainings alone


def comparisons(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each pair (better, worse) and metric, or of one row with a map's size.

    A difference counts from twice the thesis's own from run to run, which is 0.0013 in LPIPS.
    """
    table = data.published[data.published["table"] == claim["table"]]
    values = table.set_index(["row", "column"])["value"]
    labels = table.drop_duplicates("row").set_index("row")["label"]
    if claim.get("equivalent_to") is not None:
        label, asked = labels[claim["row"]], claim["equivalent_to"]
        return [
            _equivalent(values, claim["row"], label, asked, metric, data.margins[metric])
            for metric in claim["metrics"]
        ]
    return [
        _pair(values, labels, pair, metric, data.margins[metric])
        for metric in claim["metrics"]
        for pair in claim["pairs"]
    ]


def _pair(values: Any, labels: Any, pair: list[str], metric: str, margin: float) -> Comparison:
    a, b = (values[row, metric] for row in pair)
    advantage = a - b if metric in HIGHER_IS_BETTER else b - a
    named = " against ".join(f"{labels[row]} {value:.4g}" for row, value in zip(pair, (a, b)))
    times = advantage / margin
    return Comparison(
        metric=metric,
        methods=" against ".join(labels[row] for row in pair),
        text=f"{NAMES[metric]} of {named}",
        number=f"{advantage:+.3g}",
        remark=f", {abs(times):.2g} times that from run to run ({margin:.3g})",
        supports=bool(times >= COUNTS_FROM),
        against=float(times > -COUNTS_FROM),
    )


def _equivalent(
    values: Any, row: str, label: str, asked: int, metric: str, margin: float
) -> Comparison:
    """Comparable to a map: nearer to it than to those of half and twice its size."""
    maps = {
        int(name.removeprefix(MAP)): value
        for (name, column), value in values.items()
        if column == metric and name.startswith(MAP)
    }
    sizes, errors = list(maps), [float(error_of(metric, value)) for value in maps.values()]
    better = COUNTS_FROM * (margin if metric in HIGHER_IS_BETTER else -margin)
    low, at, high = (
        _map_size(sizes, errors, float(error_of(metric, values[row, metric] + change)))
        for change in (-better, 0.0, better)
    )
    least, most = asked / np.sqrt(2), asked * np.sqrt(2)
    return Comparison(
        metric=metric,
        methods=label,
        text=f"{NAMES[metric]} of {label} {values[row, metric]:.4g}",
        number=f"as a map of {at:.0f}² [{low:.0f}², {high:.0f}²]",
        remark=f", with {COUNTS_FROM} times the difference from run to run ({margin:.3g}) either "
        f"way, where {asked}² is the nearest from {least:.0f}² to {most:.0f}²",
        supports=bool(low > least and high < most),
        against=float(not (high < least or low > most)),
    )


def _map_size(sizes: list[int], errors: list[float], error: float) -> float:
    """Texels along a side of the map with an error; 0 or infinite beyond those that are printed."""
    size = equivalent_resolution(sizes, errors, error)
    if size is None:
        return 0.0 if error > max(errors) else np.inf
    return size
