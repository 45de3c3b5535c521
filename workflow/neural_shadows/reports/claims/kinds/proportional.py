"""Proportions of columns of a table."""

from typing import Literal

import numpy as np
from pydantic import Field

from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.comparison import Comparison
from neural_shadows.reports.claims.kinds.ratio import of_another_size
from neural_shadows.reports.claims.measured import Claim, Measured, needs
from neural_shadows.sections.any_report import AnyClaim
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among


class Settings(AnyClaim):
    """A column proportional to one column rather than to another."""

    kind: Literal["proportional"] = Field(description="`proportional`")
    table: Name = Field(description="a name in `tables`")
    column: str = Field(min_length=1, description="of the table's CSV")
    to: str = Field(min_length=1, description="the claimed proportional column")
    rather_than: str = Field(min_length=1, description="the column with a worse fit")

    def check(self, config: Sections, key: str) -> None:
        check_among(f"{key}.table", self.table, config.tables)


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    return {"tables": [layout.paths.report(f"{claim['table']}.csv")]}


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """The comparison of two lines through the origin.

    The claim holds if `to` explains more of `column` than `rather_than`, all columns of `table`.
    Rows are of one run and have no interval.
    """
    name, column, over = claim["table"], claim["column"], (claim["to"], claim["rather_than"])
    table = data.tables[name]
    fields = {"metric": column, "methods": f"{over[0]} rather than {over[1]}"}
    fields["text"] = f"{column} as a line through the origin ({name})"
    if reason := of_another_size(table, column, needs(claim, "device")):
        return [Comparison(**fields, incomparable=reason)]
    if missing := [each for each in (column, *over) if each not in table]:
        return [Comparison(**fields, untested=f"no {', '.join(missing)} in {name}")]
    shares = [explained(table[column].to_numpy(), table[each].to_numpy()) for each in over]
    if not np.isfinite(shares).all():
        return [
            Comparison(**fields, untested=f"no {', '.join((column, *over))} in a row of {name}")
        ]
    number = ", ".join(f"R² {share:.3f} over {each}" for share, each in zip(shares, over))
    supports, against = shares[0] > shares[1], float(shares[0] >= shares[1])
    return [Comparison(**fields, number=number, supports=supports, against=against)]


def explained(y: np.ndarray, x: np.ndarray) -> float:
    """R² of the best line through the origin.

    The share of y's squares on it, in [0, 1].
    """
    return float((x @ y) ** 2 / ((x @ x) * (y @ y)))
