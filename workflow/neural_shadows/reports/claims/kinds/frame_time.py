"""Ratios of two methods' own times, within bounds."""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
import scipy
from pydantic import Field

from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import unique
from neural_shadows.reports.claims import setting_types, views
from neural_shadows.reports.claims.claim_kinds import methods
from neural_shadows.reports.claims.comparison import Comparison
from neural_shadows.reports.claims.measured import Claim, Measured, labels, needs
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.trained import Row
from neural_shadows.reports.tables import frame_times
from neural_shadows.sections.any_report import AnyClaim
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among


class Settings(setting_types.Bounded, AnyClaim):
    """The ratio of two methods' own median times, within bounds."""

    bounded = "a claim on frame_time"

    kind: Literal["frame_time"] = Field(description="`frame_time`")
    table: Name = Field(description="a table of `frame_times` in `tables`")
    pairs: setting_types.Pairs = Field(
        description="methods of one scene; the first's time over the second's"
    )
    overhead_ms: float = Field(
        0.0,
        ge=0,
        lt=1e6,
        description="milliseconds of a frame beside the method, added to both own times",
    )

    def check(self, config: Sections, key: str) -> None:
        timed = [n for n, table in config.tables.items() if isinstance(table, frame_times.Settings)]
        check_among(f"{key}.table", self.table, timed)
        views.check_methods(config, f"{key}.pairs", self.pairs)
        rows = config.tables[self.table].resolved_rows(config)
        for pair in self.pairs:
            scene = views.compared_rows(config, pair)[0]["scene"]
            for method in pair:
                on_scene = [row["method"] for row in rows if row["scene"] == scene]
                check_among(f"{key}.pairs", method, on_scene)

    def resolved(self, config: Sections) -> dict[str, Any]:
        rows = [views.compared_rows(config, pair) for pair in self.pairs]
        return self.model_dump() | {"rows": rows}


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    rows = methods(claim)
    scenes = unique(row["scene"] for row in rows)
    times = [layout.paths.times(claim["table"], scene) for scene in scenes]
    return views.row_files(layout, rows) | {"times": times}


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each pair of a scene: the first's time over the second's.

    By the median over frames of the ratio of own milliseconds. The claim's `overhead_ms` is added to
    both, the rest of a frame: the thesis compares whole frames, and its rest is faster than ours.
    Methods take turns on each frame, so that disturbances of the machine affect both, and the
    median ignores them. Interval and p-values are exact (sign test).
    """
    return [_comparison(claim, pair, data) for pair in claim["rows"]]


def _comparison(claim: Claim, pair: Sequence[Row], data: Measured) -> Comparison:
    timed = data.times[claim["table"], pair[0]["scene"]]["methods"]
    times = [timed[row["method"]] for row in pair]
    own, overhead = [np.array(each["own_ms"]) for each in times], claim["overhead_ms"]
    texts = [
        f"{label} {short(np.median(ms))} ms (frame {short(np.median(each['ms']))} ms)"
        for label, ms, each in zip(labels(pair), own, times)
    ]
    bounds = setting_types.bounds_of(claim)
    lower, upper = bounds.get("at_least", 0.0), bounds.get("at_most", np.inf)
    fields = {
        "metric": "own milliseconds",
        "methods": " against ".join(labels(pair)),
        "text": f"own time of {' against '.join(texts)}",
        "incomparable": _unlike_devices([each["device"] for each in times], needs(claim, "device")),
    }
    ratios = (own[0] + overhead) / (own[1] + overhead)
    low, high = scipy.stats.quantile_test(ratios).confidence_interval(0.95)
    if np.isnan([low, high]).any():  # of five frames or fewer
        return Comparison(**fields, untested=f"{len(ratios)} frames are too few: it takes 6")
    with_rest = f", with {overhead:g} ms beside the method" if overhead else ""
    below = scipy.stats.quantile_test(ratios, q=lower, alternative="less").pvalue
    above = scipy.stats.quantile_test(ratios, q=upper, alternative="greater").pvalue
    return Comparison(
        **fields,
        number=f"ratio {short(np.median(ratios))} [{short(low)}, {short(high)}]",
        remark=f"{with_rest} ({setting_types.in_words(bounds)})",
        supports=bool(low > lower and high < upper),
        against=min(1.0, 2 * min(below, above)),
    )


def _unlike_devices(devices: Sequence[str], needed: str | None) -> str:
    """The reason against comparable devices, if any."""
    if len({*devices, needed or devices[0]}) == 1:
        return ""
    return f"times on {needed or 'one device'} are needed, not on {' and on '.join(devices)}"
