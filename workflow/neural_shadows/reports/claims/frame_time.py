"""Pairs (slower, faster) of a scene by the ratio of the methods' own times, within bounds."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.stats import quantile_test

from neural_shadows.reports.claims.comparison import Comparison, unjudged
from neural_shadows.reports.claims.measured import Measured, Row, labels
from neural_shadows.reports.digits import short


def comparisons(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each pair, by the median over frames of the ratio of own milliseconds.

    To both are added the claim's `overhead_ms`, what a frame takes beside the method: the thesis
    speaks of whole frames, and ours beside the method are not as fast as its. Each frame is
    answered by all methods in turn, so that a disturbance of the machine meets both, and a median
    does not see it. Interval and p-values are exact (sign test).
    """
    return [_compared(claim, pair, data) for pair in claim["pairs"]]


def devices(claim: Mapping[str, Any], data: Measured) -> dict[str, str]:
    """The class of device of each method, by label."""
    return {
        label: data.times[claim["table"], row["scene"]]["methods"][row["method"]]["device"]
        for pair in claim["pairs"]
        for label, row in zip(labels(pair), pair)
    }


def _compared(claim: Mapping[str, Any], pair: Sequence[Row], data: Measured) -> Comparison:
    timed = data.times[claim["table"], pair[0]["scene"]]["methods"]
    found = [timed[row["method"]] for row in pair]
    own, overhead = [np.array(one["own_ms"]) for one in found], claim["overhead_ms"]
    texts = [
        f"{label} {short(np.median(ms))} ms (frame {short(np.median(one['ms']))} ms)"
        for label, ms, one in zip(labels(pair), own, found)
    ]
    asked = {key: claim[key] for key in ("at_least", "at_most") if claim[key] is not None}
    limits = " and ".join(f"{key.replace('_', ' ')} {limit:g}" for key, limit in asked.items())
    least, most = asked.get("at_least", 0.0), asked.get("at_most", np.inf)
    kept = {
        "metric": "own milliseconds",
        "methods": " against ".join(labels(pair)),
        "text": f"own time of {' against '.join(texts)}",
    }
    ratios = (own[0] + overhead) / (own[1] + overhead)
    low, high = quantile_test(ratios).confidence_interval(0.95)
    if np.isnan([low, high]).any():  # of five frames or fewer
        return Comparison(**kept, **unjudged(untested=f"{len(ratios)} frames are too few"))
    with_rest = f", with {overhead:g} ms beside the method" if overhead else ""
    below = quantile_test(ratios, q=least, alternative="less").pvalue
    above = quantile_test(ratios, q=most, alternative="greater").pvalue
    return Comparison(
        **kept,
        number=f"ratio {short(np.median(ratios))} [{short(low)}, {short(high)}]",
        remark=f"{with_rest} ({limits})",
        supports=bool(low > least and high < most),
        against=min(1.0, 2 * min(below, above)),
    )
