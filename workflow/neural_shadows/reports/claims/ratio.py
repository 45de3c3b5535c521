"""Numbers of tables against each other: one over another, within bounds."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import norm

from neural_shadows.evaluation.soft_method_names import UNLEARNED
from neural_shadows.metrics.intervals import LEVEL, t_interval
from neural_shadows.reports.claims.comparison import Comparison, unjudged
from neural_shadows.reports.claims.measured import Measured
from neural_shadows.reports.digits import short
from neural_shadows.reports.tables.screen_rows import learned_rows

TIMES = ("runtime", "time")
WITHOUT_TRUNK = "no network with a perceptual loss: it needs a pretrained trunk"


def comparisons(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each of a claim's ratios of two cells of one table.

    Each of a claim's `ratios` has a `table` and a `column`, which `of` and `to`, values by column,
    find the rows of (with several `to` it is over their mean, without any over the sum of all other
    rows, with a number over that), and `at_least` or `at_most`; with `per` each row's number is
    divided first by that column's. What trained networks measure is not judged by fewer trainings
    than the claim needs: a seed is one of the table, and one each of those in `again`. Of more than
    one the ratios' logarithms decide, by Student's t.
    """
    return [_compared(claim, ratio, data) for ratio in claim["ratios"]]


def without_networks(claim: Mapping[str, Any], data: Measured) -> dict[str, list[Comparison]]:
    """The same ratios of what learns nothing, by what that is; without networks there is none.

    It takes the place of a network that stands on both sides, else of the one that is to have the
    smaller number. A table without rows of it says nothing of that.
    """
    if not claim["networks"]:
        return {}
    return {null: [_of_null(one, data, null) for one in claim["ratios"]] for null in UNLEARNED}


def _of_null(ratio: Mapping[str, Any], data: Measured, null: str) -> Comparison:
    """Within bounds only strictly: to be level with itself is no merit."""
    value, limits = _null_ratio(data.tables[ratio["table"]], ratio, null), _limits(ratio)
    inside = [value > x if key == "at_least" else value < x for key, x in limits.items()]
    kept = {"metric": ratio["column"], "methods": null, "text": null}
    return Comparison(**kept, number=f"ratio {value:.3g}", supports=all(inside), against=1.0)


def _null_ratio(table: pd.DataFrame, ratio: Mapping[str, Any], null: str) -> float:
    """The ratio with a null in the place of networks; NaN where the table has no row of it."""
    of, to = ratio["of"], ratio["to"]
    if ratio.get("unlearned") is not None:
        return ratio["unlearned"] / to
    if "null" not in table or to is None:
        return float("nan")
    unlearned = table[table["null"] == null]
    rows = to if isinstance(to, list) else [to]
    networks = [_network_in(unlearned, one) for one in (of, *rows) if isinstance(one, dict)]
    both = all(one == networks[0] for one in networks)
    winner = of if ratio["at_least"] is None or not isinstance(to, dict) else to

    def number(where: Mapping[str, Any] | float) -> float:
        if isinstance(where, float):
            return where
        if not both and where is not winner:
            return _number_in(learned_rows(table), ratio, where)
        named = {key: value for key, value in where.items() if key not in networks[0]}
        return _number_in(unlearned, ratio, named)

    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.divide(number(of), np.mean([number(one) for one in rows])))


def _network_in(unlearned: pd.DataFrame, where: Mapping[str, Any]) -> dict[str, Any]:
    """The part of a row's description that names a network: what no row of a null has."""
    return {
        key: value
        for key, value in where.items()
        if key not in unlearned or not (unlearned[key].astype(str) == str(value)).any()
    }


def _compared(claim: Mapping[str, Any], ratio: Mapping[str, Any], data: Measured) -> Comparison:
    named = (ratio["table"], *_again(claim, ratio))
    tables = [learned_rows(data.tables[name]) for name in named]
    names = [_name(ratio[key]) for key in ("of", "to")]
    column = f"{ratio['column']} per {ratio['per']}" if ratio["per"] else ratio["column"]
    kept = {"metric": column, "methods": f"{names[0]} over {names[1]}"}
    values = np.array([_values(table, ratio) for table in tables])
    means = [f" {value:.4g}" for value in values.mean(axis=0)]
    if isinstance(ratio["to"], float):
        means[1] = ""  # is its own name
    texts = [f"{name}{mean}" for name, mean in zip(names, means)]
    kept["text"] = f"{column} of {' over '.join(texts)} ({ratio['table']})"
    needs = claim.get("needs") or {}
    if why := of_another_size(tables[0], ratio["column"], needs.get("device")):
        return Comparison(**kept, **unjudged(incomparable=why))
    if not np.isfinite(values).all():
        return Comparison(**kept, **unjudged(untested=f"no {column} of one of them"))
    if needs.get("trunk") and not _perceptual(claim, data):
        return Comparison(**kept, **unjudged(untested=WITHOUT_TRUNK))
    ratios = values[:, 0] / values[:, 1]
    needed = needs.get("seeds") or 1
    if claim["networks"] and len(tables) < needed:
        why = f"{len(tables)} seed{'s' * (len(tables) > 1)} of {needed}"
        number = _number(ratios, _limits(ratio))
        return Comparison(**kept, **number, supports=False, against=1.0, untested=why)
    if (ends := _ends(tables, ratio)) is not None:
        return Comparison(**kept, **_with_ends(ratios[0], ends, _limits(ratio)))
    return Comparison(**kept, **_number(ratios, _limits(ratio)), **_judged(ratios, _limits(ratio)))


def _perceptual(claim: Mapping[str, Any], data: Measured) -> bool:
    """Whether one of a claim's networks learned by a perceptual distance."""
    records = [data.screen_trainings[name] for name in claim["networks"]]
    return any(record["perceptual"] != "none" for record in records)


def of_another_size(table: pd.DataFrame, column: str, device: str | None = None) -> str:
    """Why a column's numbers are not what a claim is about; empty if they are."""
    if column not in TIMES:
        return ""
    # Methods for soft shadows are timed on a CPU alone.
    timed = table["device"] if "device" in table else pd.Series("cpu", table.index)
    if device and not (timed == device).all():
        return f"times on {device} are needed"
    if column == "runtime" and not table["of_printed_size"].all():
        return "times of frames that have not the paper's size"
    return ""


def _again(claim: Mapping[str, Any], ratio: Mapping[str, Any]) -> list[str]:
    return claim["again"].get(ratio["table"], [])


def _values(table: pd.DataFrame, ratio: Mapping[str, Any]) -> list[float]:
    value, over = _number_in(table, ratio, ratio["of"]), ratio["to"]
    if over is None:
        return [value, table[ratio["column"]].sum() - value]
    if isinstance(over, float):
        return [value, over]
    over = over if isinstance(over, list) else [over]
    return [value, float(np.mean([_number_in(table, ratio, one) for one in over]))]


def _number_in(table: pd.DataFrame, ratio: Mapping[str, Any], where: Mapping[str, Any]) -> float:
    """A row's number, with `per` over its other."""
    value = _cell(table, ratio["column"], where)
    return value / _cell(table, ratio["per"], where) if ratio["per"] else value


def _limits(ratio: Mapping[str, Any]) -> dict[str, float]:
    return {key: ratio[key] for key in ("at_least", "at_most") if ratio[key] is not None}


def _number(ratios: np.ndarray, limits: Mapping[str, float]) -> dict[str, str]:
    """The ratio, of several their geometric mean, and its bounds, in words."""
    bounds = " and ".join(f"{key.replace('_', ' ')} {limit:g}" for key, limit in limits.items())
    mean, low, high, _ = np.exp(t_interval(_log(ratios)))
    interval = f" [{short(low)}, {short(high)}] over {len(ratios)} seeds" if len(ratios) > 1 else ""
    return {"number": f"ratio {short(mean)}{interval}", "remark": f" ({bounds})"}


def _judged(ratios: np.ndarray, limits: Mapping[str, float]) -> dict[str, Any]:
    """Whether ratios are within bounds: the only one as it is, several by Student's t."""
    sides = {"at_least": 1, "at_most": -1}
    inside = {key: sides[key] * _log(ratios / limit) for key, limit in limits.items()}
    if len(ratios) == 1:
        holds = all(one >= 0 for one in inside.values())
        return {"supports": holds, "against": float(holds)}
    found = [t_interval(one) for one in inside.values()]
    against = [p for mean, _, _, p in found if mean < 0]
    return {
        "supports": all(low > 0 for _, low, _, _ in found),
        "against": min(against, default=1.0),
    }


def _ends(tables: Sequence[pd.DataFrame], ratio: Mapping[str, Any]) -> np.ndarray | None:
    """The ends of a number's own interval over a given one; None if it has none, or no part here."""
    columns = [f"{ratio['column']}_{end}" for end in ("low", "high")]
    alone = len(tables) == 1 and isinstance(ratio["to"], float) and not ratio["per"]
    if not alone or any(column not in tables[0] for column in columns):
        return None
    return np.array([_cell(tables[0], column, ratio["of"]) for column in columns]) / ratio["to"]


def _with_ends(ratio: float, ends: np.ndarray, limits: Mapping[str, float]) -> dict[str, Any]:
    """What a ratio with an interval of its own says; without ends it decides nothing."""
    bounds = " and ".join(f"{key.replace('_', ' ')} {limit:g}" for key, limit in limits.items())
    if not np.isfinite(ends).all():
        return unjudged(untested=f"ratio {ratio:.3g} ({bounds}) without an interval")
    low, high = ends
    half = np.log(high / low) / 2
    sides = {"at_least": 1, "at_most": -1}
    inside = {key: sides[key] * np.log(ratio / limit) for key, limit in limits.items()}
    # As of a normal distribution whose interval this is.
    wide = norm.ppf((1 + LEVEL) / 2)
    against = [2 * norm.sf(wide * -one / half) for one in inside.values() if one < 0]
    return {
        "number": f"ratio {ratio:.3g} [{low:.3g}, {high:.3g}]",
        "remark": f" ({bounds})",
        "supports": all(one > half for one in inside.values()),
        "against": float(min(against, default=1.0)),
    }


def _log(ratios: np.ndarray) -> np.ndarray:
    """Natural logarithms; of 0, which is within any upper bound, −∞."""
    with np.errstate(divide="ignore"):
        return np.log(ratios)


def _name(where: Mapping[str, Any] | Sequence[Mapping[str, Any]] | float | None) -> str:
    if isinstance(where, float):
        return f"{where:g}"
    if isinstance(where, list):
        return f"the mean of {' and '.join(map(_name, where))}"
    return "all others" if where is None else ", ".join(map(str, where.values()))


def _cell(table: pd.DataFrame, column: str, where: Mapping[str, Any]) -> float:
    """The number of a column in the only row with these values; NaN if there is none such."""
    rows = table
    for name, value in where.items():
        rows = rows[rows[name].astype(str) == str(value)] if name in rows else rows[:0]
    found = pd.to_numeric(rows.get(column, pd.Series(dtype=float)), errors="coerce")
    return float(found.iloc[0]) if len(found) == 1 else float("nan")
