"""Which of two columns of a table a third one is proportional to."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from neural_shadows.reports.claims.comparison import Comparison, unjudged
from neural_shadows.reports.claims.measured import Measured
from neural_shadows.reports.claims.ratio import of_another_size


def comparisons(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """The only comparison of a claim: a line through the origin over the column `to` explains more of
    `column` than one over `rather_than`, both of `table`.

    Rows are of one run, so that nothing is said of chance.
    """
    name, column, over = claim["table"], claim["column"], (claim["to"], claim["rather_than"])
    table = data.tables[name]
    kept = {"metric": column, "methods": f"{over[0]} rather than {over[1]}"}
    kept["text"] = f"{column} as a line through the origin ({name})"
    if why := of_another_size(table, column, (claim.get("needs") or {}).get("device")):
        return [Comparison(**kept, **unjudged(incomparable=why))]
    if missing := [one for one in (column, *over) if one not in table]:
        return [Comparison(**kept, **unjudged(untested=f"no {', '.join(missing)} in {name}"))]
    shares = [explained(table[column].to_numpy(), table[one].to_numpy()) for one in over]
    told = ", ".join(f"R² {share:.3f} over {one}" for share, one in zip(shares, over))
    holds = shares[0] > shares[1]
    return [Comparison(**kept, number=told, supports=holds, against=float(holds))]


def explained(y: np.ndarray, x: np.ndarray) -> float:
    """R² of the best line through the origin: which share of y's squares is on it, in [0, 1]."""
    return float((x @ y) ** 2 / ((x @ x) * (y @ y)))
