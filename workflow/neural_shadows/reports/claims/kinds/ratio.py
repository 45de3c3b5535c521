"""Numbers of tables over each other, within bounds."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal

import numpy as np
import pandas as pd
import scipy
from pydantic import Field, model_validator

from neural_shadows.evaluation.registry import UNLEARNED
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.intervals import LEVEL, t_interval
from neural_shadows.reports.claims import screen_networks, setting_types
from neural_shadows.reports.claims.comparison import Comparison, of_all_pixels, seeds_of
from neural_shadows.reports.claims.measured import Claim, Measured, needs
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.soft_frames import learned_rows
from neural_shadows.sections.any_report import AnyClaim
from neural_shadows.sections.experiments import ScreenExperimentName
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among

WITHOUT_TRUNK = "no network with a perceptual loss: it needs a pretrained trunk"
TIMES = ("runtime", "time")
SIDES = {"at_least": 1, "at_most": -1}
Row = Annotated[dict[str, str | bool | int], Field(min_length=1)]
Size = Annotated[float, Field(gt=0, lt=1e12)]


class Ratio(setting_types.Bounded):
    """A number of a table over another of its column."""

    bounded = "a ratio"

    table: Name = Field(description="a name in `tables`")
    column: str = Field(min_length=1, description="of the table's CSV")
    of: Row = Field(description="its row: value by column")
    to: Row | Annotated[list[Row], Field(min_length=2)] | Size | None = Field(
        None,
        description="the denominator's row, or several for their mean, or a number; "
        "without it the sum of all other rows",
    )
    per: str | None = Field(
        None, min_length=1, description="a column that divides both numbers first"
    )

    @model_validator(mode="after")
    def _check_sides(self):
        if self.per is not None and self.to is None:
            raise ValueError("a ratio to the sum of all others has no `per`")
        return self


class Settings(AnyClaim):
    """Numbers of tables over each other, within bounds."""

    kind: Literal["ratio"] = Field(description="`ratio`")
    ratios: list[Ratio] = Field(min_length=1, description="all must hold")
    networks: list[ScreenExperimentName] = Field(
        [], description="the trained networks of the claim"
    )
    again: setting_types.again(Name) = Field(
        {},
        description="by table, its counterparts of networks from other seeds",
    )

    def _other_seeds(self, config: Sections) -> list[tuple[str, list[str]]]:
        return [
            (network, [x for other in others for x in _same_in(config, network, other)])
            for table, others in self.again.items()
            for network in self._networks_in(config, table)
        ]

    def _networks_in(self, config: Sections, table: str) -> list[str]:
        shown = config.tables[table].methods_shown()
        return [network for network in self.networks if network in shown]

    def check(self, config: Sections, key: str) -> None:
        for ratio in self.ratios:
            check_among(f"{key}.ratios.table", ratio.table, config.tables)
        for table, others in self.again.items():
            check_among(f"{key}.again", table, [ratio.table for ratio in self.ratios])
            for other in others:
                check_among(f"{key}.again.{table}", other, config.tables)
                for network in self._networks_in(config, table):
                    if not _same_in(config, network, other):
                        raise ValueError(
                            f"{key}.again.{table}: {other!r} has no network that differs from "
                            f"{network!r} in `seed` and `label` alone"
                        )
        screen_networks.check_seeds(config, key, self._other_seeds(config))

    def resolved(self, config: Sections) -> dict[str, Any]:
        networks = screen_networks.all_seeds(config, self.networks, self._other_seeds(config))
        return self.model_dump() | {"networks": networks}


def _same_in(config: Sections, network: str, table: str) -> list[str]:
    """A network's counterparts in a table, from other seeds."""
    others = dict.fromkeys(config.tables[table].methods_shown())
    others = [x for x in others if x in config.screen_experiments and x != network]
    return [x for x in others if not config.differences(network, x)]


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    other_seeds = [table for others in claim["again"].values() for table in others]
    tables = [*(ratio["table"] for ratio in claim["ratios"]), *other_seeds]
    paths = [layout.paths.report(f"{table}.csv") for table in tables]
    return {"tables": paths, **screen_networks.files(layout, claim)}


def _ratios(claim: Claim) -> list[Ratio]:
    return [Ratio(**ratio) for ratio in claim["ratios"]]


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each ratio.

    Numbers of trained networks are not judged with fewer seeds than the claim needs: one of the
    table, and one of each in `again`. Several are tested by Student's t of the ratios' logarithms.
    """
    return [_comparison(claim, ratio, data) for ratio in _ratios(claim)]


def without_networks(claim: Claim, data: Measured) -> dict[str, list[Comparison]]:
    """The ratios of null predictors, by null, of those that have all, see `_null_ratio`."""
    if not claim["networks"]:
        return {}
    nulls = {null: [_of_null(ratio, data, null) for ratio in _ratios(claim)] for null in UNLEARNED}
    return {null: ratios for null, ratios in nulls.items() if all(each.number for each in ratios)}


not_learned = screen_networks.not_learned


def by_all_pixels(claim: Claim) -> Claim | None:
    ratios = [ratio | {"column": of_all_pixels(ratio["column"])} for ratio in claim["ratios"]]
    return {**claim, "ratios": ratios} if ratios != claim["ratios"] else None


def of_another_size(table: pd.DataFrame, column: str, device: str | None = None) -> str:
    """The reason against comparable times, if any."""
    if column not in TIMES:
        return ""
    # Methods for soft shadows are timed on a CPU alone.
    timed = table["device"] if "device" in table else pd.Series("cpu", table.index)
    if device and not (timed == device).all():
        return f"times on {device} are needed"
    if column == "runtime" and not table["of_printed_size"].all():
        return "times of frames that have not the paper's size"
    return ""


def _of_null(ratio: Ratio, data: Measured, null: str) -> Comparison:
    """A null's ratio, without a number if it has none; supports only strictly within bounds."""
    value = _null_ratio(data.tables[ratio.table], ratio, null)
    if not np.isfinite(value):
        return Comparison(metric=ratio.column, methods=null, text=null)
    inside = [
        SIDES[key] * (value - x) > 0
        for key, x in setting_types.bounds_of(ratio.model_dump()).items()
    ]
    fields = {"metric": ratio.column, "methods": null, "text": null}
    return Comparison(**fields, number=f"ratio {value:.3g}", supports=all(inside))


def _null_ratio(table: pd.DataFrame, ratio: Ratio, null: str) -> float:
    """The ratio of a null where a network is compared with itself, NaN elsewhere.

    It is the frames' difference, if a null has it too. Nulls do not err more in unseen scenes, or
    flicker: only claims of a larger number are tested. Of two networks both would be the null.
    """
    of, to = ratio.of, ratio.to
    if "null" not in table or to is None or ratio.at_least is None:
        return float("nan")
    nulls, rows = table[table["null"] == null], to if isinstance(to, list) else [to]
    # A null's rows have all columns but those that name a network.
    networks = [
        {
            key: value
            for key, value in where.items()
            if key not in nulls or not (nulls[key].astype(str) == str(value)).any()
        }
        for where in (of, *rows)
        if isinstance(where, dict)
    ]
    if any(network != networks[0] for network in networks):
        return float("nan")

    def number(where: Row | float) -> float:
        if isinstance(where, float):
            return where
        named = {key: value for key, value in where.items() if key not in networks[0]}
        return _number_in(nulls, ratio, named)

    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.divide(number(of), np.mean([number(row) for row in rows])))


def _comparison(claim: Claim, ratio: Ratio, data: Measured) -> Comparison:
    names = (ratio.table, *claim["again"].get(ratio.table, ()))
    tables = [learned_rows(data.tables[name]) for name in names]
    column = f"{ratio.column} per {ratio.per}" if ratio.per else ratio.column
    values = np.array([_values(table, ratio) for table in tables])
    sides = [_name(side) for side in (ratio.of, ratio.to)]
    means = [f" {value:.4g}" for value in values.mean(axis=0)]
    if isinstance(ratio.to, float):
        means[1] = ""  # its name is the number
    named = " over ".join(f"{side}{mean}" for side, mean in zip(sides, means))
    fields = {"metric": column, "methods": " over ".join(sides)}
    fields["text"] = f"{column} of {named} ({ratio.table})"
    if reason := of_another_size(tables[0], ratio.column, needs(claim, "device")):
        return Comparison(**fields, incomparable=reason)
    if not np.isfinite(values).all():
        return Comparison(**fields, untested=f"no {column} of one of them")
    networks = claim["networks"]
    if needs(claim, "trunk") and all(
        data.screen_trainings[name]["perceptual"] == "none" for name in networks
    ):
        return Comparison(**fields, untested=WITHOUT_TRUNK)
    ratios, needed = values[:, 0] / values[:, 1], needs(claim, "seeds") or 1
    bounds, ends = setting_types.bounds_of(ratio.model_dump()), _ends(tables, ratio)
    bounds_text = f" ({setting_types.in_words(bounds)})"
    if networks and len(tables) < needed:
        fields |= {"number": _number(ratios), "remark": bounds_text}
        return Comparison(**fields, untested=seeds_of(len(tables), needed))
    if ends is not None and not np.isfinite(ends).all():
        reason = f"ratio {ratios[0]:.3g}{bounds_text} without an interval"
        return Comparison(**fields, untested=reason)
    return Comparison(**fields, remark=bounds_text, **_judged(ratios, ends, bounds))


def _values(table: pd.DataFrame, ratio: Ratio) -> list[float]:
    value, to = _number_in(table, ratio, ratio.of), ratio.to
    if to is None:
        return [value, table[ratio.column].sum() - value]
    rows = to if isinstance(to, list) else [to]
    return [value, float(np.mean([_number_in(table, ratio, row) for row in rows]))]


def _number_in(table: pd.DataFrame, ratio: Ratio, where: Row | float) -> float:
    """A row's number, divided by `per`; a given one."""
    if isinstance(where, float):
        return where
    value = _cell(table, ratio.column, where)
    if not ratio.per:
        return value
    with np.errstate(divide="ignore", invalid="ignore"):  # all dark never changes
        return float(np.divide(value, _cell(table, ratio.per, where)))


def _cell(table: pd.DataFrame, column: str, where: Row) -> float:
    """A column's number in the only matching row, or NaN."""
    rows = table
    for name, value in where.items():
        rows = rows[rows[name].astype(str) == str(value)] if name in rows else rows[:0]
    numbers = pd.to_numeric(rows.get(column, pd.Series(dtype=float)), errors="coerce")
    return float(numbers.iloc[0]) if len(numbers) == 1 else float("nan")


def _ends(tables: Sequence[pd.DataFrame], ratio: Ratio) -> np.ndarray | None:
    """Ends of a number's own interval over a given number."""
    columns = [f"{ratio.column}_{end}" for end in ("low", "high")]
    alone = len(tables) == 1 and isinstance(ratio.to, float) and not ratio.per
    if not alone or any(column not in tables[0] for column in columns):
        return None
    return np.array([_cell(tables[0], column, ratio.of) for column in columns]) / ratio.to


def _number(ratios: np.ndarray) -> str:
    """The ratio as text; the geometric mean of several."""
    mean, low, high, _ = np.exp(t_interval(_log(ratios)))
    interval = f" [{short(low)}, {short(high)}] over {len(ratios)} seeds" if len(ratios) > 1 else ""
    return f"ratio {short(mean)}{interval}"


def _judged(
    ratios: np.ndarray, ends: np.ndarray | None, bounds: Mapping[str, float]
) -> dict[str, Any]:
    """Judge ratios by bounds.

    Several by Student's t, one by its own interval if any, else as it is.
    """
    number = _number(ratios)
    inside = [SIDES[key] * _log(ratios / bound) for key, bound in bounds.items()]
    if ends is not None:
        number = f"ratio {ratios[0]:.3g} [{ends[0]:.3g}, {ends[1]:.3g}]"
        # As a normal distribution with this interval.
        half_width, z_95 = np.log(ends[1] / ends[0]) / 2, scipy.stats.norm.ppf((1 + LEVEL) / 2)
        tests = [
            (d, d - half_width, 2 * scipy.stats.norm.sf(z_95 * -d / half_width)) for (d,) in inside
        ]
    elif len(ratios) == 1:
        tests = [(1, 1, 1.0) if d >= 0 else (-1, -1, 0.0) for (d,) in inside]
    else:
        tests = [(mean, low, p) for mean, low, _, p in map(t_interval, inside)]
    return {
        "number": number,
        "supports": all(low > 0 for _, low, _ in tests),
        "against": float(min((p for mean, _, p in tests if mean < 0), default=1.0)),
    }


def _log(ratios: np.ndarray) -> np.ndarray:
    """Natural logarithms; of 0, within any upper bound, −∞."""
    with np.errstate(divide="ignore"):
        return np.log(ratios)


def _name(where: Row | Sequence[Row] | float | None) -> str:
    if isinstance(where, float):
        return f"{where:g}"
    if isinstance(where, list):
        return f"the mean of {' and '.join(map(_name, where))}"
    return "all others" if where is None else ", ".join(map(str, where.values()))
