"""Numbers of tables against each other: one over another, within bounds."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.metrics.intervals import t_interval
from neural_shadows.reports.claims.comparison import Comparison, unjudged
from neural_shadows.reports.claims.measured import Measured
from neural_shadows.reports.digits import short

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


def _compared(claim: Mapping[str, Any], ratio: Mapping[str, Any], data: Measured) -> Comparison:
    tables = [data.tables[name] for name in (ratio["table"], *_again(claim, ratio))]
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
    return Comparison(**kept, **_number(ratios, _limits(ratio)), **_judged(ratios, _limits(ratio)))


def _perceptual(claim: Mapping[str, Any], data: Measured) -> bool:
    """Whether one of a claim's networks learned by a perceptual distance."""
    records = [data.screen_trainings[name] for name in claim["networks"]]
    return any(record["perceptual"] != "none" for record in records)


def of_another_size(table: pd.DataFrame, column: str, device: str | None = None) -> str:
    """Why a column's numbers are not what a claim is about; empty if they are."""
    if column != "runtime":
        return ""
    if not table["of_printed_size"].all():
        return "times of frames that have not the paper's size"
    if device and not (table["device"] == device).all():
        return f"times on {device} are needed"
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
