"""Whether a network has learned: whether it is better than drawing no shadow at all."""

from collections.abc import Mapping, Sequence

import pandas as pd

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.metrics.intervals import (
    FEWEST_VIEWS,
    paired_difference,
    pooled_psnr_difference,
)
from neural_shadows.settings.records import Row

Advantage = tuple[float, float, float]  # a value and the ends of its 95 % interval

THESIS_METRICS = ("lpips", "psnr", "ssim")  # of its tables: in what it is better

HIGHER_IS_BETTER = ("psnr", "ssim")
# The configuration that the thesis prints twice, trained anew: its difference is what chance does.
SAME = (("4.1", "poisson_quadtree"), ("4.2", "frequencies_10"))


def margins(published: pd.Series) -> dict[str, float]:
    """The thesis's own difference from run to run in each metric that it prints (0.18 dB).

    `published` is as `read_published` gives it.
    """
    first, second = (published.unstack().loc[printed] for printed in SAME)
    return (first - second).abs().dropna().to_dict()


def advantage(a: pd.Series, b: pd.Series, metric: str, seed: int) -> Advantage:
    """By how much `a` is better than `b`, of the same views, in a metric: positive if it is.

    Of PSNR the difference of pooled PSNRs, in dB; of others the mean difference.
    """
    if metric == "psnr":
        return pooled_psnr_difference(a.to_numpy(), b.to_numpy(), seed)
    better, worse = (a, b) if metric in HIGHER_IS_BETTER else (b, a)
    return paired_difference(better.to_numpy(), worse.to_numpy(), seed)


def learned(
    network: pd.DataFrame,
    null: pd.DataFrame,
    metrics: Sequence[str],
    margins: Mapping[str, float],
    seed: int,
) -> dict[str, Advantage]:
    """By how much a network is better than no shadow on the same views, beyond a margin.

    Args:
        network, null: a row a view, in one order, and a column a metric; null: of `no_shadow`.
        metrics: which to compare.
        margins: of each metric, 0 of those that are not there.
        seed: of the bootstrap over views.

    Returns: of each metric the `advantage` less its margin.
    """
    found = {}
    for metric in metrics:
        ends = advantage(network[metric], null[metric], metric, seed)
        found[metric] = tuple(end - margins.get(metric, 0.0) for end in ends)
    return found


def learned_methods(
    wide: pd.DataFrame,
    rows: Sequence[Row],
    margins: Mapping[str, float],
    seed: int,
) -> dict[str, bool]:
    """Whether each trained network is better than no shadow, in all that the thesis prints.

    In LPIPS, or without it in FLIP, in pooled PSNR and in SSIM. Of too few views for an interval
    nothing is said: there are no methods then.

    Args:
        wide: as `values_by_view` gives it, with `NO_SHADOW`.
        rows: as `config.rows_of` gives them; those that are not `trained` are left out.
    """
    if len(wide) < FEWEST_VIEWS:
        return {}
    perceived = "lpips" if (NO_SHADOW, "lpips") in wide else "flip"
    metrics = (perceived, *THESIS_METRICS[1:])
    found = {
        row["method"]: learned(wide[row["method"]], wide[NO_SHADOW], metrics, margins, seed)
        for row in rows
        if row["trained"]
    }
    return {method: has_learned(advantages) for method, advantages in found.items()}


def has_learned(advantages: Mapping[str, Advantage]) -> bool:
    """Whether every interval of `learned` lies above 0."""
    return all(low > 0 for _, low, _ in advantages.values())
