"""Claims on methods for soft shadows."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.soft_registry import UNLEARNED, is_network
from neural_shadows.frames.feature_names import BASES
from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.error_scale import error_of
from neural_shadows.metrics.intervals import FEWEST_SCENES, FEWEST_VIEWS, scenes_interval
from neural_shadows.reports.claims import setting_types
from neural_shadows.reports.claims.claim_kinds import kind_of
from neural_shadows.reports.claims.comparison import NAMES, Comparison, judged, seeds_of, unjudged
from neural_shadows.reports.claims.measured import Claim, Measured, needs
from neural_shadows.reports.claims.network_claims import NetworksClaim, training_files
from neural_shadows.reports.data.digits import short
from neural_shadows.sections.frame_tables import MethodsTable
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among, name_in
from neural_shadows.settings.records import SoftTimes

ITS_BASE = "base"  # a null predictor by network: its base, or the light's map
# Factors of values, see their names in `NAMES`.
FACTORS = {"mse": 1e4, "mse_off_edges": 1e4, "l1": 100, "light_leak": 100, "false_shadow": 100}


class SoftClaim(NetworksClaim):
    """Methods for soft shadows, compared on the same frames.

    Its kind has `named_methods()`, those of its table.
    """

    of_tables: ClassVar[tuple[type[MethodsTable], ...]]  # the kinds of its table

    table: Name = Field(description="a table of `soft_methods` or `soft_summary` in `tables`")
    again: setting_types.again(name_in("screen_experiments")) = Field(
        {}, description="by network, its counterparts trained from other seeds"
    )

    def named_networks(self) -> Iterator[str]:
        return filter(is_network, self.named_methods())

    def other_seeds(self, config: Sections) -> Iterator[tuple[str, list[str]]]:
        yield from self.again.items()

    def check(self, config: Sections, key: str) -> None:
        allowed = [n for n, table in config.tables.items() if isinstance(table, self.of_tables)]
        check_among(f"{key}.table", self.table, allowed)
        table = config.tables[self.table]
        frames = config.frame_sets[table.frame_set]
        if isinstance(frames, OwnFrames):
            raise ValueError(
                f"{key}.table: {self.table!r} is of a user's own frames. Choose another table"
            )
        methods = self.named_methods()
        for method in methods:
            check_among(f"{key}: {self.table}.methods", method, table.methods_shown())
        for method in self.again:
            networks = [name for name in methods if name in config.screen_experiments]
            check_among(f"{key}.again", method, networks)
        for k in self.radii or ():
            if k >= len(frames.radii):
                raise ValueError(
                    f"{key}.radii: {k} is not below {len(frames.radii)}, the number of radii of "
                    f"{table.frame_set!r}"
                )
        super().check(config, key)

    def resolved(self, config: Sections) -> dict[str, Any]:
        """The settings with `networks` and, by network, `bases`."""
        bases = {
            name: feature
            for name in self.all_networks(config)
            for feature in config.screen_network_of(name).features
            if feature in BASES
        }
        return super().resolved(config) | {"bases": bases}


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    """Files of a claim's table, other seeds and null predictors."""
    table, frame_set = claim["table"], soft_methods.frame_set(layout, claim["table"])
    methods = [name for others in claim["again"].values() for name in others]
    if claim["networks"]:
        methods += [*UNLEARNED, *claim["bases"].values()]
    beside = [layout.paths.soft_evaluation("csv", frame_set, method) for method in methods]
    return {
        "soft_metrics": [*soft_methods.evaluations(layout, table, "csv"), *beside],
        "soft_times": soft_methods.times(layout, table),
        **training_files(layout, claim),
    }


@dataclass(frozen=True)
class SoftTable:
    """Values and times of methods for soft shadows.

    Args:
        values: a row a frame (scene, part, frame), a column a (method, metric, radius).
        labels: by method; times: of `time_soft_methods`, None without timing; radii: texts with
            their unit.
    """

    values: pd.DataFrame
    labels: Mapping[str, str]
    times: SoftTimes | None
    radii: Sequence[str]

    def milliseconds(self, method: str, radius: int | None) -> float:
        """Milliseconds of a frame, with its map's.

        NaN for untimed methods; without a radius the mean over all.
        """
        timed = self.times["methods"].get(method) if self.times else None
        if timed is None:
            return float("nan")
        own = np.mean(timed["ms"]) if radius is None else timed["ms"][radius]
        return own + self.times["maps"].get(timed["map"], {"ms": 0.0})["ms"]

    def errors(self, method: str, metric: str, radius: int | None) -> pd.Series | None:
        """Errors of each frame, if measured; 1 − SSIM."""
        radii = range(len(self.radii)) if radius is None else [radius]
        columns = [(method, metric, k) for k in radii]
        if any(column not in self.values for column in columns):
            return None
        means = FACTORS.get(metric, 1) * self.values[columns].mean(axis=1, skipna=False)
        return means.map(partial(error_of, metric))


def soft_values(metrics: pd.DataFrame) -> pd.DataFrame:
    """The `values` of a `SoftTable` from the rows of `read_soft_metrics`."""
    index, columns = ["scene", "part", "frame"], ["method", "metric", "radius"]
    return metrics.pivot_table("value", index, columns)


def without_networks(claim: Claim, data: Measured) -> dict[str, list[Comparison]]:
    """The comparisons with null predictors for networks, by null.

    In each pair the null replaces the claimed winner, or the loser where only that is a network;
    times stay the networks'. Empty without networks.
    """
    if not claim.get("networks"):
        return {}
    nulls = (*UNLEARNED, *([ITS_BASE] if claim.get("bases") else ()))
    compare = kind_of(claim).comparisons
    return {null: compare({**claim, "null": null}, data) for null in nulls}


def comparison(
    claim: Claim, data: Measured, metric: str, radius: int | None, pair: Sequence[str]
) -> Comparison:
    """Compare two methods by paired differences over scenes and seeds.

    The interval is that of `scenes_interval`. Frames do not show how trainings differ: with fewer
    seeds of a network than the claim needs (two by default) nothing is judged. Other seeds of a
    network are `again` of its name.
    """
    table = data.soft[claim["table"]]
    if null := claim.get("null"):
        runs = _with_null(pair, null, claim.get("bases", {}))
        return _of_runs(table, metric, radius, pair, runs)
    other_seeds, needed = claim.get("again") or {}, needs(claim, "seeds") or 2
    runs = [[method, *other_seeds.get(method, ())] for method in pair]
    seeds = min((len(names) for names in runs if is_network(names[0])), default=None)
    outcome = _of_runs(table, metric, radius, pair, [names[:seeds] for names in runs])
    if seeds is None or seeds >= needed or outcome.untested:
        return outcome
    return replace(outcome, supports=False, against=1.0, untested=seeds_of(seeds, needed))


def _with_null(pair: Sequence[str], null: str, bases: Mapping[str, str]) -> list[list[str]]:
    """The runs of a pair, its first network's a null's."""
    index = next((k for k, method in enumerate(pair) if is_network(method)), None)
    stand_in = null if index is None or null != ITS_BASE else bases.get(pair[index], "hard")
    return [[stand_in] if k == index else [method] for k, method in enumerate(pair)]


def _of_runs(
    table: SoftTable,
    metric: str,
    radius: int | None,
    pair: Sequence[str],
    runs: Sequence[Sequence[str]],
) -> Comparison:
    """Compare two methods by their runs.

    Both have the same number of seeds, or one a single run.
    """
    labels = [table.labels[name] for name in pair]
    light = "all lights" if radius is None else table.radii[radius]
    fields = {"metric": metric, "methods": f"{' against '.join(labels)} at {light}"}
    errors = [[table.errors(run, metric, radius) for run in names] for names in runs]
    if missing := [
        label for label, series in zip(labels, errors) if any(x is None for x in series)
    ]:
        reason = f"no {NAMES[metric]} of {', '.join(missing)}"
        return Comparison(**fields, text=fields["methods"], **unjudged(untested=reason))
    frames = [pd.concat(series, axis=1) for series in errors]
    means = [error_of(metric, each.groupby("scene").mean().mean(axis=None)) for each in frames]
    times = [table.milliseconds(name, radius) for name in pair]
    texts = [
        f"{label} {short(mean)}" + ("" if np.isnan(ms) else f" ({ms:.0f} ms)")
        for label, mean, ms in zip(labels, means, times)
    ]
    fields["text"] = f"{NAMES[metric]} at {light} of {' against '.join(texts)}"
    first, second = (each.to_numpy() for each in frames)
    gain = pd.DataFrame(second - first, frames[0].index).dropna()  # broadcasts one run over several
    scenes = gain.index.get_level_values("scene").to_numpy()
    count = len(set(scenes))
    if count < FEWEST_SCENES and len(gain) < FEWEST_VIEWS:
        return Comparison(**fields, **unjudged(untested=f"{len(gain)} frames are too few"))
    units = f"{count} scenes" if count >= FEWEST_SCENES else f"{len(gain)} frames in {count} scene"
    units += "s" * (1 < count < FEWEST_SCENES)
    interval = scenes_interval(gain.to_numpy().T, scenes)
    return Comparison(**fields, **judged(*interval), remark=f" over {units}")
