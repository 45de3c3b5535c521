"""Numbers of tables against each other: one over another, within bounds."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from neural_shadows.reports.claims.comparison import Comparison, unjudged
from neural_shadows.reports.claims.measured import Measured


def comparisons(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each of a claim's ratios of two cells of one table.

    Each of a claim's `ratios` has a `table` and a `column`, which `of` and `to`, values by column,
    find the rows of (without `to` it is over the sum of all other rows), and `at_least` or
    `at_most`. What trained networks measure is not judged by fewer trainings than the claim needs.
    """
    return [_compared(claim, ratio, data) for ratio in claim["ratios"]]


def _compared(claim: Mapping[str, Any], ratio: Mapping[str, Any], data: Measured) -> Comparison:
    table = data.tables[ratio["table"]]
    names = [_name(ratio[key]) for key in ("of", "to")]
    kept = {"metric": ratio["column"], "methods": f"{names[0]} over {names[1]}"}
    values = [_cell(table, ratio["column"], ratio["of"])]
    if ratio["to"] is None:
        values.append(table[ratio["column"]].sum() - values[0])
    else:
        values.append(_cell(table, ratio["column"], ratio["to"]))
    texts = [f"{name} {value:.4g}" for name, value in zip(names, values)]
    kept["text"] = f"{ratio['column']} of {' over '.join(texts)} ({ratio['table']})"
    if ratio["column"] == "runtime" and not table["of_printed_size"].all():
        return Comparison(
            **kept, **unjudged(incomparable="times of frames that have not the paper's size")
        )
    if not all(value == value for value in values):
        return Comparison(**kept, **unjudged(untested=f"no {ratio['column']} of one of them"))
    found = values[0] / values[1]
    asked = {key: ratio[key] for key in ("at_least", "at_most") if ratio[key] is not None}
    limits = " and ".join(f"{key.replace('_', ' ')} {limit:g}" for key, limit in asked.items())
    number = {"number": f"ratio {found:.3g}", "remark": f" ({limits})"}
    needed = (claim.get("needs") or {}).get("seeds") or 1
    if claim["networks"] and needed > 1:
        why = f"1 seed of {needed}"
        return Comparison(**kept, **number, supports=False, against=1.0, untested=why)
    holds = asked.get("at_least", 0.0) <= found <= asked.get("at_most", float("inf"))
    return Comparison(**kept, **number, supports=holds, against=float(holds))


def _name(where: Mapping[str, Any] | None) -> str:
    return "all others" if where is None else ", ".join(map(str, where.values()))


def _cell(table: pd.DataFrame, column: str, where: Mapping[str, Any]) -> float:
    """The number of a column in the only row with these values; NaN if there is none such."""
    rows = table
    for name, value in where.items():
        rows = rows[rows[name].astype(str) == str(value)] if name in rows else rows[:0]
    found = pd.to_numeric(rows.get(column, pd.Series(dtype=float)), errors="coerce")
    return float(found.iloc[0]) if len(found) == 1 else float("nan")
