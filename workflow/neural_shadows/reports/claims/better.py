"""Pairs (better, worse) of methods by the means over views of image metrics."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.metrics.error_scale import value_of
from neural_shadows.metrics.intervals import FEWEST_VIEWS, two_way_interval
from neural_shadows.metrics.pooled_psnr import psnr_of
from neural_shadows.metrics.power_law import FEWEST_BUDGETS, Curve
from neural_shadows.reports.claims.comparison import NAMES, Comparison, judged, unjudged
from neural_shadows.reports.claims.learning import Learning, followed
from neural_shadows.reports.claims.measured import NO_SHADOW_ROW, Budget, Measured, Row, labels
from neural_shadows.reports.digits import short


def comparisons(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each pair and metric, at the largest budget that the pair has in common.

    Where nothing differs in truth, three seeds decide 2 to 5 % of 300 simulated claims, for noise
    of seeds 0.3 to 10 times that of views; resampled seeds 7 to 22 %, views alone 9 to 82 %.
    """
    return [
        _compared(pair, data.metric(pair[0], metric), data)
        for metric in claim["metrics"]
        for pair in claim["pairs"]
    ]


def without_networks(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """The same comparisons with drawing no shadow in the place of each network that is trained."""
    pairs = [
        [NO_SHADOW_ROW | {"scene": row["scene"]} if row["trained"] else row for row in pair]
        for pair in claim["pairs"]
    ]
    return comparisons({**claim, "pairs": pairs}, data)


def _compared(pair: Sequence[Row], metric: str, data: Measured) -> Comparison:
    """Methods of one scene are seen from the same views, and compared view by view."""
    kept = {"metric": metric, "methods": " against ".join(labels(pair))}
    if why := data.unshared(pair):
        text = f"{NAMES[metric]} of {kept['methods']}"
        return Comparison(**kept, text=text, **unjudged(incomparable=why))
    budgets = data.budgets(pair)
    a, b = (data.errors(row, metric, budgets[-1]) for row in pair)
    fewest, seeds = min(len(a), len(b)), budgets[-1].seeds
    kept |= {
        "text": _text(pair, metric, a, b),
        "seeds": seeds if budgets[-1].runs else None,
        "samples": budgets[-1].samples,
    }
    if fewest < FEWEST_VIEWS:
        return Comparison(**kept, **unjudged(untested=f"{fewest} views are too few"))
    values, groups, advantage = _arranged(pair, metric, a, b)
    found = two_way_interval(values, data.seed, advantage, groups)
    learning = _learning(pair, metric, budgets, data, (values, groups, advantage))
    return Comparison(**kept, **judged(*found), learning=learning)


def _arranged(
    pair: Sequence[Row], metric: str, a: pd.DataFrame, b: pd.DataFrame
) -> tuple[np.ndarray, np.ndarray, Callable[[np.ndarray], float]]:
    """Both methods' errors for `two_way_interval`, the views' groups, and the advantage of (S, …).

    Of one scene (S, V, 2), as the views are the same; of two the views of one after the other's.
    """
    sets = [frame.index.get_level_values("view_set") for frame in (a, b)]
    first, second = a.to_numpy().T, b.to_numpy().T
    gain = _psnr_gain if metric == "psnr" else _error_gain
    if pair[0]["scene"] == pair[1]["scene"]:
        values = np.stack([first, second], axis=2)
        return values, np.array(sets[0]), lambda v: gain(v[..., 0].mean(), v[..., 1].mean())
    groups = [f"{scene} {name}" for scene, names in enumerate(sets) for name in names]
    count = len(a)
    values = np.concatenate([first, second], axis=1)
    return values, np.array(groups), lambda v: gain(v[:, :count].mean(), v[:, count:].mean())


def _learning(
    pair: Sequence[Row],
    metric: str,
    budgets: Sequence[Budget],
    data: Measured,
    last: tuple[np.ndarray, np.ndarray, Callable[[np.ndarray], float]],
) -> Learning | None:
    """The advantage over all budgets, if there are enough of them."""
    if budgets[-1].samples is None or len(budgets) < FEWEST_BUDGETS:
        return None
    samples = np.array([budget.samples for budget in budgets])
    errors = [[data.errors(row, metric, one).mean() for one in budgets] for row in pair]
    curves = [Curve(samples, np.array(means)) for means in errors]
    values, groups, advantage = last
    of_views = values.mean(0, keepdims=True)
    value, low, high, _ = two_way_interval(of_views, data.seed, advantage, groups)
    return followed(
        *curves,
        learn=[row["trained"] for row in pair],
        died=any(data.died(row, budgets) for row in pair),
        psnr=metric == "psnr",
        views=(value - low, high - value),
        seed=data.seed,
    )


def _text(pair: Sequence[Row], metric: str, a: pd.DataFrame, b: pd.DataFrame) -> str:
    """The methods and their means; of PSNR the pooled ones."""
    values = [_shown(metric, frame.to_numpy().mean()) for frame in (a, b)]
    named = [f"{label} {value}" for label, value in zip(labels(pair), values)]
    return f"{NAMES[metric]} of {' against '.join(named)}"


def _shown(metric: str, error: float) -> str:
    return f"{short(value_of(metric, error))}{' dB' if metric == 'psnr' else ''}"


def _error_gain(a: float, b: float) -> float:
    return b - a


def _psnr_gain(a: float, b: float) -> float:
    return psnr_of(a) - psnr_of(b)
