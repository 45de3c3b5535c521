"""Methods for soft shadows, compared on the frames of a table."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import TypedDict

import numpy as np
import pandas as pd

from neural_shadows.evaluation.registry import UNLEARNED, is_network
from neural_shadows.frames.feature_names import BASES
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.report_inputs import Report
from neural_shadows.metrics.intervals import FEWEST_SCENES, FEWEST_VIEWS, kinds_of, scenes_interval
from neural_shadows.metrics.kinds import sequences
from neural_shadows.metrics.registry import frame_metrics, metrics
from neural_shadows.reports.claims import screen_networks
from neural_shadows.reports.claims.comparison import Comparison, judged, of_all_pixels, seeds_of
from neural_shadows.reports.claims.measured import Claim, Measured, needs
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.frame_means import count_scenes
from neural_shadows.reports.data.lights import POINT
from neural_shadows.reports.data.soft_costs import cost
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.records import SoftTimes

METRICS = [*frame_metrics("soft"), *sequences.METRICS]
# One of a pair: rays of its kind that take as long as the other, or as its first seed.
EQUAL_TIME = {"rays_of_equal_time": r"rt_(\d+)", "ffx_rays_of_equal_time": r"rt_(\d+)_ffx"}
# A null predictor by network: its base, or the light's map; of rays as many independent ones, which err 6 to 9 %
# less than the even ones that it gets.
ITS_BASE = "base"

not_learned = screen_networks.not_learned


class TableSettings(TypedDict):
    """Settings of a table of methods for soft shadows; `radii` as texts, `lights`: numbers of those that count."""

    frame_set: str
    labels: dict[str, str]
    scenes: list[str]
    lights: list[int]
    radii: list[str]


@dataclass(frozen=True)
class SoftTable:
    """Values and times of methods for soft shadows.

    Args:
        values: a row a frame (scene, part, frame), a column a (method, metric, radius).
        labels: by method; times: of `time_methods`, None without timing; radii: their
            `light_sizes`; lights: numbers of those of which means are.
    """

    values: pd.DataFrame
    labels: Mapping[str, str]
    times: SoftTimes | None
    radii: Sequence[str]
    lights: Sequence[int]

    def milliseconds(self, method: str, radius: int | None) -> float:
        """Milliseconds of a frame, with its map's.

        NaN for untimed methods; without a radius the mean over all.
        """
        if self.times is None:
            return float("nan")
        numbers = self.lights if radius is None else [radius]
        return float(np.mean([cost(self.times, method, number)["ms"] for number in numbers]))

    def errors(self, method: str, metric: str, radius: int | None) -> pd.Series | None:
        """Errors of each frame, if measured; 1 − SSIM."""
        radii = self.lights if radius is None else [radius]
        columns = [(method, metric, k) for k in radii]
        if any(column not in self.values for column in columns):
            return None
        measured = metrics()[metric]
        means = measured.factor * self.values[columns].mean(axis=1, skipna=False)
        return means.map(measured.error)

    def light(self, radius: int | None) -> str:
        """The light of a radius, or all, in words."""
        every = (
            "all lights" if len(self.lights) == len(self.radii) else f"{len(self.lights)} lights"
        )
        size = every if radius is None else self.radii[radius]
        return "a point light" if size == POINT else size

    def rays_about(
        self, kind: str, milliseconds: float, radius: int | None
    ) -> tuple[str | None, str | None]:
        """The most rays in a time, and the next larger number. None where there are none.

        Args:
            kind: a key of `EQUAL_TIME`.
        """
        matches = {name: re.fullmatch(EQUAL_TIME[kind], name) for name in self.labels}
        rays = {name: int(match[1]) for name, match in matches.items() if match}
        times = {name: self.milliseconds(name, radius) for name in rays}
        most = max((n for n in times if times[n] <= milliseconds), key=rays.get, default=None)
        timed = (n for n in times if np.isfinite(times[n] - milliseconds))
        more = (n for n in timed if rays[n] > rays.get(most, 0))
        return most, min(more, key=rays.get, default=None)

    def of_scenes(self, scenes: Sequence[str]) -> "SoftTable":
        """The table of these scenes' frames alone."""
        return replace(self, values=self.values[self.values.index.isin(scenes, level="scene")])


def soft_values(metrics: pd.DataFrame) -> pd.DataFrame:
    """The `values` of a `SoftTable` from the rows of `read_metrics`."""
    index, columns = ["scene", "part", "frame"], ["method", "metric", "radius"]
    return metrics.pivot_table("value", index, columns)


def bases(config: Sections, networks: Sequence[str]) -> dict[str, str]:
    """The method that is the base of each network with one."""
    return {
        name: _method(config, name, feature)
        for name in networks
        for feature in config.network_of(name).features
        if feature in BASES
    }


def _method(config: Sections, network: str, base: str) -> str:
    if base != "base_rays":
        return base
    frame_set = config.screen_experiments[network].frame_set
    return f"rt_{config.frame_sets[frame_set].rays}"


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    """Files of a claim's table, other seeds and null predictors."""
    table = claim["table"]
    report = Report(layout, table, layout.entry("tables", table))
    methods = [*report.methods, *(name for others in claim["again"].values() for name in others)]
    if claim["networks"]:
        methods += [*UNLEARNED, *claim["bases"].values()]
    return {
        "soft_metrics": report.evaluated("csv", methods),
        "soft_times": tables.times(layout, table),
        **screen_networks.files(layout, claim),
    }


def comparisons(claim: Claim, data: Measured, null: str = "") -> list[Comparison]:
    """A comparison for each pair, metric and radius, see `_comparison` and `_in_equal_time`."""
    table, radii = data.soft[claim["table"]], claim["radii"] or [None]
    if claim.get("scenes"):
        table = table.of_scenes(claim["scenes"])
    return [
        (_comparison if EQUAL_TIME.keys().isdisjoint(pair) else _in_equal_time)(
            claim, table, metric, radius, pair, null
        )
        for pair, metric, radius in product(claim["pairs"], claim["metrics"], radii)
    ]


def without_networks(claim: Claim, data: Measured) -> dict[str, list[Comparison]]:
    """The comparisons with null predictors for networks, by null.

    In each pair the null replaces the claimed winner, or the loser where only that is a network;
    times stay the networks'. Empty without networks.
    """
    if not claim.get("networks"):
        return {}
    nulls = (*UNLEARNED, *([ITS_BASE] if claim.get("bases") else ()))
    return {null: comparisons(claim, data, null) for null in nulls}


def network_wins(claim: Claim) -> bool:
    """Check for a network as claimed winner."""
    return any(winner not in EQUAL_TIME and is_network(winner) for winner, _ in claim["pairs"])


def by_all_pixels(claim: Claim) -> Claim | None:
    """The claim on errors of all pixels, if on those off edges."""
    metrics = [*map(of_all_pixels, claim["metrics"])]
    return {**claim, "metrics": metrics} if metrics != claim["metrics"] else None


def soft_table(claim: Claim) -> str:
    """The table of a claim."""
    return claim["table"]


def _in_equal_time(
    claim: Claim,
    table: SoftTable,
    metric: str,
    radius: int | None,
    pair: Sequence[str],
    null: str,
) -> Comparison:
    """Compare a method with rays of its time, by the two numbers of rays about it.

    None takes exactly that, and times differ by some percent from run to run. So what supports the
    claim must hold with the number that is worse for it, and what is against it with the better one:
    rays that are to win with those that take no longer, rays that are to lose with the next larger number.
    """
    rays = next(method for method in pair if method in EQUAL_TIME)
    (other,) = set(pair) - {rays}
    limit, label = table.milliseconds(other, radius), table.labels.get(other, other)
    by_number = [
        number
        and _comparison(
            claim, table, metric, radius, [number if m == rays else m for m in pair], null
        )
        for number in table.rays_about(rays, limit, radius)
    ]
    worse, better = by_number if rays == pair[0] else by_number[::-1]
    if worse is None and better is None:
        text = f"{label} at {table.light(radius)}"
        return Comparison(metric, label, text, untested="the table has no times of it and of rays")
    if better is None or worse is not None and worse.supports:
        outcome = replace(worse, against=1.0)
    else:
        beside = f"; beside it {worse.text}: {worse.number or worse.untested}" if worse else ""
        outcome = replace(better, supports=False, remark=f"{better.remark}{beside}")
    if None in by_number and not outcome.supports and outcome.against == 1:
        missing = ("fewer", "more")[by_number.index(None)]
        return outcome.without(
            f"{label} takes {limit:.0f} ms, for which the table has no {missing} rays"
        )
    return outcome


def _comparison(
    claim: Claim,
    table: SoftTable,
    metric: str,
    radius: int | None,
    pair: Sequence[str],
    null: str,
) -> Comparison:
    """Compare two methods by paired differences over scenes and seeds.

    The interval is that of `scenes_interval`. Frames do not show how trainings differ: with fewer
    seeds of a network than the claim needs (two by default) nothing is judged. Other seeds of a
    network are `again` of its name; both methods have the same number of them, or one a single run.

    Args:
        null: a null predictor in the first network's place, or "".
    """
    other_seeds, needed = claim.get("again") or {}, needs(claim, "seeds") or 2
    measured = metrics()[metric]
    runs = [[method, *other_seeds.get(method, ())] for method in pair]
    network = next((k for k, method in enumerate(pair) if is_network(method)), None)
    seeds = None
    if null:
        runs = [[method] for method in pair]
        if network is not None:
            base = claim.get("bases", {}).get(pair[network], "hard")
            runs[network] = [base if null == ITS_BASE else null]
    elif network is not None:
        seeds = min(len(names) for names in runs if is_network(names[0]))
        runs = [names[:seeds] for names in runs]
    labels = [table.labels.get(name, name) for name in pair]  # it may not be available here
    light = table.light(radius)
    methods = f"{' against '.join(labels)} at {light}"
    fields = {"metric": metric, "methods": methods, "seeds": seeds}
    errors = [[table.errors(run, metric, radius) for run in names] for names in runs]
    if missing := [
        label for label, series in zip(labels, errors) if any(x is None for x in series)
    ]:
        reason = f"no {measured.text} of {', '.join(missing)}"
        return Comparison(**fields, text=fields["methods"], untested=reason)
    frames = [pd.concat(series, axis=1) for series in errors]
    means = [measured.value(each.groupby("scene").mean().mean(axis=None)) for each in frames]
    times = [table.milliseconds(name, radius) for name in pair]
    texts = [
        f"{label} {short(mean)}" + ("" if np.isnan(ms) else f" ({ms:.0f} ms)")
        for label, mean, ms in zip(labels, means, times)
    ]
    fields["text"] = f"{measured.text} at {light} of {' against '.join(texts)}"
    first, second = (each.to_numpy() for each in frames)
    gain = pd.DataFrame(second - first, frames[0].index).dropna()  # broadcasts one run over several
    scenes = gain.index.get_level_values("scene").to_numpy()
    count, kinds = len(set(scenes)), len(set(kinds_of(scenes)))
    if kinds < FEWEST_SCENES and len(gain) < FEWEST_VIEWS:
        few = f"{len(gain)} frames are too few: it takes {FEWEST_VIEWS}, or {FEWEST_SCENES} kinds of scenes"
        return Comparison(**fields, untested=few)
    units = f"{len(gain)} frames in {count} scene{'s' * (count > 1)}"
    if kinds >= FEWEST_SCENES:
        units = count_scenes([*set(scenes)])
    interval = scenes_interval(gain.to_numpy().T, scenes)
    outcome = Comparison(**fields, **judged(*interval), remark=f" over {units}")
    return outcome if seeds is None or seeds >= needed else outcome.without(seeds_of(seeds, needed))
