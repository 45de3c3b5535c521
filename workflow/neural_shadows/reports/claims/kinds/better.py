"""Pairs (better, worse) of methods by means of image metrics."""

from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.metrics.error_scale import value_of
from neural_shadows.metrics.intervals import FEWEST_VIEWS, two_way_interval
from neural_shadows.metrics.pooled_psnr import psnr_of
from neural_shadows.reports.claims import row_claims, setting_types, unlearned
from neural_shadows.reports.claims.comparison import NAMES, Comparison, judged, unjudged
from neural_shadows.reports.claims.learning import follow
from neural_shadows.reports.claims.measured import NO_SHADOW_ROW, Claim, Measured, labels
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.trained import Row

NEEDS_SEEDS = True
# Both methods' errors for `two_way_interval`, the advantage of (S, …), and the views' groups.
Arranged = tuple[np.ndarray, Callable[[np.ndarray], float], np.ndarray]


class Settings(row_claims.RowsClaim):
    """Methods compared by image metrics."""

    kind: Literal["better"] = Field(description="`better`")
    pairs: setting_types.pairs() = Field(
        description="methods, one of them a network; the claimed winner first"
    )
    metrics: setting_types.metrics("lpips", "psnr", "ssim", "flip", "shadow_error") = Field(
        ["lpips"],
        description="image metrics; the claim must hold in all of them; FLIP replaces LPIPS "
        "where its backbone is missing",
    )


compared = row_claims.compared_in_pairs
files = row_claims.picture_files
not_learned = unlearned.by_frames


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each pair and metric.

    At the pair's largest common budget. Intervals are those of `two_way_interval`, views within
    their view sets; the object is fixed, so that they do not cover other objects.
    """
    return [
        _comparison(pair, data.metric(pair[0], metric), data)
        for metric in claim["metrics"]
        for pair in claim["pairs"]
    ]


def without_networks(claim: Claim, data: Measured) -> dict[str, list[Comparison]]:
    """The comparisons with no shadow for trained networks."""
    if not any(row["trained"] for pair in claim["pairs"] for row in pair):
        return {}
    pairs = [
        [NO_SHADOW_ROW | {"scene": row["scene"]} if row["trained"] else row for row in pair]
        for pair in claim["pairs"]
    ]
    return {NO_SHADOW: comparisons({**claim, "pairs": pairs}, data)}


def network_wins(claim: Claim) -> bool:
    return any(winner["trained"] for winner, _ in claim["pairs"])


def _comparison(pair: Sequence[Row], metric: str, data: Measured) -> Comparison:
    fields = {"metric": metric, "methods": " against ".join(labels(pair))}
    if reason := data.unshared(pair):
        text = f"{NAMES[metric]} of {fields['methods']}"
        return Comparison(**fields, text=text, **unjudged(incomparable=reason))
    budgets = data.budgets(pair)
    a, b = (data.errors(row, metric, budgets[-1]) for row in pair)
    fewest, seeds = min(len(a), len(b)), budgets[-1].seeds
    fields |= {
        "text": _text(pair, metric, a, b),
        "seeds": seeds if budgets[-1].runs else None,
        "samples": budgets[-1].samples,
    }
    if fewest < FEWEST_VIEWS:
        return Comparison(**fields, **unjudged(untested=f"{fewest} views are too few"))
    values, advantage, groups = _arranged(pair, metric, a, b)
    value, low, high, _ = two_way_interval(values.mean(0, keepdims=True), advantage, groups)
    means = [[data.errors(row, metric, budget).mean() for budget in budgets] for row in pair]
    views = value - low, high - value
    learning = follow(pair, budgets, means, data, metric == "psnr", views)
    interval = two_way_interval(values, advantage, groups)
    return Comparison(**fields, **judged(*interval), learning=learning)


def _arranged(pair: Sequence[Row], metric: str, a: pd.DataFrame, b: pd.DataFrame) -> Arranged:
    """Arrange the errors of a pair.

    For one scene (S, V, 2), compared view by view; for two scenes the views concatenated.
    """
    sets = [frame.index.get_level_values("view_set") for frame in (a, b)]
    first, second = a.to_numpy().T, b.to_numpy().T

    def gain(x: np.ndarray, y: np.ndarray) -> float:
        x, y = x.mean(), y.mean()
        return psnr_of(x) - psnr_of(y) if metric == "psnr" else y - x

    if pair[0]["scene"] == pair[1]["scene"]:
        values = np.stack([first, second], axis=2)
        return values, lambda v: gain(v[..., 0], v[..., 1]), np.array(sets[0])
    groups = [f"{scene} {name}" for scene, names in enumerate(sets) for name in names]
    count = len(a)
    values = np.concatenate([first, second], axis=1)
    return values, lambda v: gain(v[:, :count], v[:, count:]), np.array(groups)


def _text(pair: Sequence[Row], metric: str, a: pd.DataFrame, b: pd.DataFrame) -> str:
    """The methods and their means; PSNR is pooled."""
    unit = " dB" if metric == "psnr" else ""
    means = [value_of(metric, frame.to_numpy().mean()) for frame in (a, b)]
    named = [f"{label} {short(mean)}{unit}" for label, mean in zip(labels(pair), means)]
    return f"{NAMES[metric]} of {' against '.join(named)}"
