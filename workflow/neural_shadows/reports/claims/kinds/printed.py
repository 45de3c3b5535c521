"""The thesis's own tables, without any training of ours."""

from typing import Any, Literal

import numpy as np
from pydantic import Field, model_validator

from neural_shadows.evaluation.registry import shadow_map_key
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.equivalent_resolution import equivalent_resolution
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.claims import setting_types
from neural_shadows.reports.claims.comparison import Comparison
from neural_shadows.reports.claims.measured import Claim, Measured
from neural_shadows.reports.data.published import PRINTED, read_published
from neural_shadows.sections.any_report import AnyClaim
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among

MAP = "shadow_map_"
WITHOUT_RUN = True
COUNTS_FROM = 2  # times the difference from run to run, of two trainings alone


class Settings(AnyClaim):
    """Pairs of printed rows, or a row's equal."""

    kind: Literal["printed"] = Field(description="`printed`")
    table: str = Field(pattern=r"^4\.[1-7]$", description="the thesis's number of a table")
    pairs: setting_types.Pairs | None = Field(
        None, description="rows of published.csv, the winner first"
    )
    row: str | None = Field(None, description="a row of published.csv, for `equivalent_to`")
    equivalent_to: int | None = Field(
        None, ge=2, le=32768, description="texels along a side of the equivalent map"
    )
    metrics: setting_types.metrics("lpips", "psnr", "ssim") = Field(
        description="columns of published.csv; the claim must hold in all of them"
    )

    @model_validator(mode="after")
    def _check_parts(self):
        parts = self.pairs is not None, self.row is not None, self.equivalent_to is not None
        if parts not in ((True, False, False), (False, True, True)):
            raise ValueError("a printed claim needs `pairs`, or `row` and `equivalent_to`")
        return self

    def check(self, config: Sections, key: str) -> None:
        printed = read_published(PRINTED["thesis"]).loc[self.table].unstack()
        if self.pairs is None:
            rows = [self.row, shadow_map_key(self.equivalent_to)]
        else:
            rows = [row for pair in self.pairs for row in pair]
        for row in rows:
            check_among(f"{key}: rows of table {self.table}", row, printed.index)
        for metric in self.metrics:
            check_among(f"{key}.metrics of table {self.table}", metric, printed.columns)


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    return {}


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each pair (better, worse) and metric.

    With `equivalent_to` a comparison of a row with a map's size for each metric. Differences count
    from twice the thesis's own from run to run, 0.0013 in LPIPS.
    """
    table = data.published[data.published["table"] == claim["table"]]
    values = table.set_index(["row", "column"])["value"]
    labels = table.drop_duplicates("row").set_index("row")["label"]
    if claim.get("equivalent_to") is not None:
        return [
            _equivalent(claim, values, labels[claim["row"]], metric, data.margins[metric])
            for metric in claim["metrics"]
        ]
    return [
        _pair(values, labels, pair, metric, data.margins[metric])
        for metric in claim["metrics"]
        for pair in claim["pairs"]
    ]


def _pair(values: Any, labels: Any, pair: list[str], metric: str, margin: float) -> Comparison:
    a, b = (values[row, metric] for row in pair)
    measured = metrics()[metric]
    advantage = a - b if measured.better == "high" else b - a
    named = " against ".join(f"{labels[row]} {value:.4g}" for row, value in zip(pair, (a, b)))
    times = advantage / margin
    return Comparison(
        metric=metric,
        methods=" against ".join(labels[row] for row in pair),
        text=f"{measured.text} of {named}",
        number=f"{advantage:+.3g}",
        remark=f", {abs(times):.2g} times that from run to run ({margin:.3g})",
        supports=bool(times >= COUNTS_FROM),
        against=float(times > -COUNTS_FROM),
    )


def _equivalent(claim: Claim, values: Any, label: str, metric: str, margin: float) -> Comparison:
    """Compare a row with a map's size.

    It must be nearer to that than to half and twice the size.
    """
    row, texels, measured = claim["row"], claim["equivalent_to"], metrics()[metric]
    maps = {
        int(name.removeprefix(MAP)): value
        for (name, column), value in values.items()
        if column == metric and name.startswith(MAP)
    }
    sizes, errors = list(maps), [float(measured.error(value)) for value in maps.values()]
    better = COUNTS_FROM * (margin if measured.better == "high" else -margin)
    low, at, high = (
        _map_size(sizes, errors, float(measured.error(values[row, metric] + change)))
        for change in (-better, 0.0, better)
    )
    lower, upper = texels / np.sqrt(2), texels * np.sqrt(2)
    return Comparison(
        metric=metric,
        methods=label,
        text=f"{measured.text} of {label} {values[row, metric]:.4g}",
        number=f"as a map of {at:.0f}² [{low:.0f}², {high:.0f}²]",
        remark=f", with {COUNTS_FROM} times the difference from run to run ({margin:.3g}) either "
        f"way, where {texels}² is the nearest from {lower:.0f}² to {upper:.0f}²",
        supports=bool(low > lower and high < upper),
        against=float(not (high < lower or low > upper)),
    )


def _map_size(sizes: list[int], errors: list[float], error: float) -> float:
    """Texels along a side of the map with an error.

    0 or infinite beyond the printed errors.
    """
    size = equivalent_resolution(sizes, errors, error)
    if size is None:
        return 0.0 if error > max(errors) else np.inf
    return size
