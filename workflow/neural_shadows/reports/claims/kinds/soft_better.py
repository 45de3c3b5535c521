"""Pairs (better, worse) of methods for soft shadows by metrics."""

from itertools import product
from typing import Literal

from pydantic import Field

from neural_shadows.evaluation.soft_registry import is_network
from neural_shadows.reports.claims import setting_types, soft_claims
from neural_shadows.reports.claims.comparison import Comparison, of_all_pixels
from neural_shadows.reports.claims.measured import Claim, Measured
from neural_shadows.reports.tables import soft_methods, soft_summary

OF_SOFT_METHODS = True


class Settings(soft_claims.SoftClaim):
    """A smaller error of one method than of another."""

    of_tables = (soft_methods.Settings, soft_summary.Settings)

    kind: Literal["soft_better"] = Field(description="`soft_better`")
    radii: list[setting_types.Radius] | None = Field(
        None,
        min_length=1,
        description="see `soft_equal_time`; without it the mean over all is compared",
    )
    pairs: setting_types.pairs() = Field(
        description="methods of the table, the claimed winner first"
    )
    metrics: setting_types.metrics(
        *("mse_off_edges", "mse", "ssim", "l1", "light_leak", "false_shadow", "flip", "lpips")
    ) = Field(
        ["mse_off_edges"],
        description="the claim must hold in all of them; the evidence names the verdict by `mse`, "
        "of all pixels, if it differs from that by `mse_off_edges`, of pixels without edges of "
        "surfaces; "
        "`flip` and `lpips` are measured for the middle light alone",
    )

    def named_methods(self) -> list[str]:
        return [method for pair in self.pairs for method in pair]


files = soft_claims.files
without_networks = soft_claims.without_networks


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each pair, metric and radius."""
    radii = claim["radii"] or [None]
    return [
        soft_claims.comparison(claim, data, metric, radius, pair)
        for pair, metric, radius in product(claim["pairs"], claim["metrics"], radii)
    ]


def network_wins(claim: Claim) -> bool:
    return any(is_network(winner) for winner, _ in claim["pairs"])


def by_all_pixels(claim: Claim) -> Claim | None:
    metrics = [*map(of_all_pixels, claim["metrics"])]
    return {**claim, "metrics": metrics} if metrics != claim["metrics"] else None
