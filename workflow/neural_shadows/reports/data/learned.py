"""Comparison of networks with drawing no shadow at all."""

from collections.abc import Mapping, Sequence

import pandas as pd

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.metrics.intervals import (
    FEWEST_VIEWS,
    paired_difference,
    pooled_psnr_difference,
)
from neural_shadows.metrics.registry import metrics
from neural_shadows.settings.records import Row

Advantage = tuple[float, float, float]  # a value and the ends of its 95 % interval

THESIS_METRICS = ("lpips", "psnr", "ssim")  # of its tables
# The configuration that the thesis prints twice, trained anew: the difference is by chance.
SAME = (("4.1", "poisson_quadtree"), ("4.2", "frequencies_10"))


def margins(published: pd.Series) -> dict[str, float]:
    """The thesis's own difference from run to run in each metric that it prints (0.18 dB).

    `published`: of `read_published`.
    """
    first, second = (published.unstack().loc[printed] for printed in SAME)
    return (first - second).abs().dropna().to_dict()


def advantage(a: pd.Series, b: pd.Series, metric: str, seed: int) -> Advantage:
    """Advantage of `a` over `b` in a metric, on the same views.

    Of PSNR the difference of pooled PSNRs, in dB; of others the mean difference.
    """
    if metric == "psnr":
        return pooled_psnr_difference(a.to_numpy(), b.to_numpy(), seed)
    better, worse = (a, b) if metrics()[metric].better == "high" else (b, a)
    return paired_difference(better.to_numpy(), worse.to_numpy(), seed)


def learned(
    network: pd.DataFrame,
    null: pd.DataFrame,
    metrics: Sequence[str],
    margins: Mapping[str, float],
    seed: int,
) -> dict[str, Advantage]:
    """Advantage of a network over no shadow, less a margin.

    Args:
        network, null: a row a view, in one order, and a column a metric; null: of `no_shadow`.
        metrics: those to compare.
        margins: of metrics, 0 by default.
        seed: of the bootstrap over views.

    Returns: of each metric the `advantage` less its margin.
    """
    advantages = {}
    for metric in metrics:
        ends = advantage(network[metric], null[metric], metric, seed)
        advantages[metric] = tuple(end - margins.get(metric, 0.0) for end in ends)
    return advantages


def learned_methods(
    wide: pd.DataFrame,
    rows: Sequence[Row],
    margins: Mapping[str, float],
    seed: int,
) -> dict[str, bool]:
    """Compare each trained network with no shadow, in the thesis's metrics.

    In LPIPS, or without it in FLIP, in pooled PSNR and in SSIM. Empty with too few
    views for an interval.

    Args:
        wide: of `values_by_view`, with `NO_SHADOW`.
        rows: of `sections.rows`; untrained ones are left out.
    """
    if len(wide) < FEWEST_VIEWS:
        return {}
    perceived = "lpips" if (NO_SHADOW, "lpips") in wide else "flip"
    metrics = (perceived, *THESIS_METRICS[1:])
    advantages_by_method = {
        row["method"]: learned(wide[row["method"]], wide[NO_SHADOW], metrics, margins, seed)
        for row in rows
        if row["trained"]
    }
    return {method: has_learned(advantages) for method, advantages in advantages_by_method.items()}


def has_learned(advantages: Mapping[str, Advantage]) -> bool:
    """Test that every interval of `learned` lies above 0."""
    return all(low > 0 for _, low, _ in advantages.values())
