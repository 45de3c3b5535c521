"""Methods for soft shadows against rays of equal time."""

from itertools import product
from typing import Literal

from pydantic import Field

from neural_shadows.evaluation.soft_registry import rays_of
from neural_shadows.reports.claims import setting_types, soft_claims
from neural_shadows.reports.claims.comparison import Comparison, of_all_pixels, unjudged
from neural_shadows.reports.claims.measured import Claim, Measured
from neural_shadows.reports.data.frame_means import OFF_EDGES
from neural_shadows.reports.tables import soft_methods

OF_SOFT_METHODS = True


class Settings(soft_claims.SoftClaim):
    """Rays of equal time and smaller squared error off edges."""

    of_tables = (soft_methods.Settings,)  # have times by radius

    kind: Literal["soft_equal_time"] = Field(description="`soft_equal_time`")
    radii: list[setting_types.Radius] = Field(
        min_length=1,
        description="numbers of the frame set's radii, from 0; the claim must hold at all of them",
    )
    methods: list[str] = Field(min_length=1, description="claimed losers, methods of the table")

    def named_methods(self) -> list[str]:
        return self.methods


files = soft_claims.files
without_networks = soft_claims.without_networks


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each method and radius.

    Rays are the most that take no longer than the method, or a network's first seed.
    """
    table, metric = data.soft[claim["table"]], claim.get("metric", OFF_EDGES)
    outcomes = []
    for method, radius in product(claim["methods"], claim["radii"]):
        limit, label = table.milliseconds(method, radius), table.labels[method]
        fitting = [
            name
            for name in table.labels
            if rays_of(name) and table.milliseconds(name, radius) <= limit
        ]
        if fitting:
            pair = max(fitting, key=rays_of), method
            outcomes.append(soft_claims.comparison(claim, data, metric, radius, pair))
        else:
            text = f"{label} takes {limit:.1f} ms at {table.radii[radius]}"
            why = unjudged(untested=f"no number of rays fits into {limit:.1f} ms")
            outcomes.append(Comparison(metric, label, text, **why))
    return outcomes


def network_wins(claim: Claim) -> bool:
    return False


def by_all_pixels(claim: Claim) -> Claim | None:
    return None if "metric" in claim else {**claim, "metric": of_all_pixels(OFF_EDGES)}
