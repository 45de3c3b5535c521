"""Methods on scenes' viewpoints, compared by image metrics."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.null_predictors import NO_SHADOW, is_null
from neural_shadows.evaluation.registry import is_classic, unbiased
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.intervals import FEWEST_VIEWS, two_way_interval
from neural_shadows.metrics.pooled_psnr import psnr_of
from neural_shadows.metrics.registry import frame_metrics, metrics
from neural_shadows.reports.claims.claim_kinds import methods
from neural_shadows.reports.claims.comparison import Comparison, interval_text, judged
from neural_shadows.reports.claims.learning import follow
from neural_shadows.reports.claims.measured import NO_SHADOW_ROW, Claim, Measured, labels
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.learned import THESIS_METRICS, has_learned, learned
from neural_shadows.reports.data.trained import Budget, Row
from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.sections.rows import row_of
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among

METRICS = frame_metrics("hard")
# Both methods' errors for `two_way_interval`, the advantage of (S, …), and the views' groups.
Arranged = tuple[np.ndarray, Callable[[np.ndarray], float], np.ndarray]


def check_methods(config: Sections, key: str, compared: Sequence[Sequence[str]]) -> None:
    """Check methods by comparison: each has a network."""
    for names in compared:
        for name in names:
            if is_null(unbiased(name)) and name != unbiased(name):
                raise ValueError(
                    f"{key}: {name!r}: a null predictor has no depth bias. Write {unbiased(name)!r}"
                )
            if not is_classic(unbiased(name)):
                check_among(key, unbiased(name), config.ray_experiments)
        if all(is_classic(unbiased(name)) for name in names):
            raise ValueError(f"{key}: {names}: no experiment among them. Add one")


def compared_rows(config: Sections, names: Sequence[str]) -> list[Row]:
    """Compared methods as rows, maps on a network's scene."""
    keys = [unbiased(name) for name in names]
    scenes = [config.ray_experiments[key].scene for key in keys if key in config.ray_experiments]
    rows = []
    for key, name in zip(keys, names):
        row = RowSettings(method=key, bias=None if key == name else "held_out")
        experiment = config.ray_experiments.get(key)
        rows.append(row_of(config, experiment.scene if experiment else scenes[0], row))
    return rows


def row_files(layout: Layout, rows: Sequence[Row]) -> dict[str, list[str]]:
    """Trainings and meshes of rows."""
    scenes = tables.unique(row["scene"] for row in rows)
    return {
        "trainings": tables.networks(layout, rows, "training.json"),
        "meshes": [layout.paths.scene("mesh.json", scene) for scene in scenes],
    }


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    """Files of a claim on images, with those without shadow."""
    rows = tables.with_curves(layout, methods(claim))
    null = tables.unshadowed(tables.unique(row["scene"] for row in rows))
    return row_files(layout, rows) | {"metrics": tables.evaluations(layout, [*rows, *null], "csv")}


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each pair and metric, see `comparison`."""
    return [
        comparison(pair, data.metric(pair[0], metric), data)
        for metric in claim["metrics"]
        for pair in claim["rows"]
    ]


def without_networks(claim: Claim, data: Measured) -> dict[str, list[Comparison]]:
    """The comparisons with no shadow for trained networks."""
    if not any(row["trained"] for row in methods(claim)):
        return {}
    rows = [
        [NO_SHADOW_ROW | {"scene": row["scene"]} if row["trained"] else row for row in pair]
        for pair in claim["rows"]
    ]
    return {NO_SHADOW: comparisons({**claim, "rows": rows}, data)}


def network_wins(claim: Claim) -> bool:
    """Check for a network as claimed winner."""
    return any(winner["trained"] for winner, _ in claim["rows"])


def not_learned(claim: Claim, data: Measured) -> str:
    """Name the networks no better than no shadow in a metric."""
    return failures(claim, data, _failure)


def failures(claim: Claim, data: Measured, failure: Callable[..., str]) -> str:
    """Name the networks with a failed training at the largest budget.

    Args:
        failure: of the claim, the data, a row and a budget: what failed, or "".
    """
    reasons = {}
    for rows in claim["rows"]:
        for budget in data.budgets(rows)[-1:]:
            for row in rows:
                if row["trained"] and (reason := failure(claim, data, row, budget)):
                    reasons[row["method"]] = f"{row['label']} ({row['scene']}): {reason}"
    return "; ".join(reasons.values())


def _failure(claim: Claim, data: Measured, row: Row, budget: Budget) -> str:
    """The first metric no better than no shadow's.

    Of the thesis's tables and of the claim. Differences count beyond the thesis's run-to-run margin;
    too few views decide nothing.
    """
    names = dict.fromkeys((*THESIS_METRICS, *claim.get("metrics", ())))
    measured = [*dict.fromkeys(data.metric(row, name) for name in names)]
    frames = data.metrics[row["scene"]]
    if len(frames) < FEWEST_VIEWS:
        return ""
    for method in data.methods(row, budget):
        gains = learned(frames[method], frames[NO_SHADOW], measured, data.margins, data.seed)
        if not has_learned(gains):
            name = next(name for name, (_, low, _) in gains.items() if not low > 0)
            metric, margin = metrics()[name], metrics()[name].factor * data.margins.get(name, 0.0)
            numbers = interval_text(*(metric.factor * gain for gain in gains[name]))
            return f"{metric.text} beats no shadow by {numbers} beyond the margin {margin:.2g}"
    return ""


def comparison(pair: Sequence[Row], name: str, data: Measured) -> Comparison:
    """Compare a pair at its largest common budget.

    Intervals are those of `two_way_interval`, views within their view sets; the object is fixed, so
    that they do not cover other objects.
    """
    metric = metrics()[name]
    fields: dict[str, Any] = {"metric": name, "methods": " against ".join(labels(pair))}
    if reason := data.unshared(pair):
        text = f"{metric.text} of {fields['methods']}"
        return Comparison(**fields, text=text, incomparable=reason)
    budgets = data.budgets(pair)
    a, b = (data.errors(row, name, budgets[-1]) for row in pair)
    fewest, seeds = min(len(a), len(b)), budgets[-1].seeds
    unit = " dB" if name == "psnr" else ""  # of pooled PSNR
    means = [metric.factor * metric.value(frame.to_numpy().mean()) for frame in (a, b)]
    named = [f"{label} {short(mean)}{unit}" for label, mean in zip(labels(pair), means)]
    fields |= {
        "text": f"{metric.text} of {' against '.join(named)}",
        "seeds": seeds if budgets[-1].runs else None,
        "samples": budgets[-1].samples,
    }
    if fewest < FEWEST_VIEWS:
        return Comparison(**fields, untested=f"{fewest} views are too few: it takes {FEWEST_VIEWS}")
    values, advantage, groups = _arranged(pair, name, a, b)
    value, low, high, _ = two_way_interval(values.mean(0, keepdims=True), advantage, groups)
    errors = [
        [metric.factor * data.errors(row, name, budget).mean() for budget in budgets]
        for row in pair
    ]
    learning = follow(pair, budgets, errors, data, name == "psnr", (value - low, high - value))
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
        return psnr_of(x) - psnr_of(y) if metric == "psnr" else metrics()[metric].factor * (y - x)

    if pair[0]["scene"] == pair[1]["scene"]:
        values = np.stack([first, second], axis=2)
        return values, lambda v: gain(v[..., 0], v[..., 1]), np.array(sets[0])
    groups = [f"{scene} {name}" for scene, names in enumerate(sets) for name in names]
    count = len(a)
    values = np.concatenate([first, second], axis=1)
    return values, lambda v: gain(v[:, :count], v[:, count:]), np.array(groups)
