"""Ratios of numbers of tables, of which claims say how large they are."""

from typing import Annotated

from pydantic import Field, model_validator

from neural_shadows.config.base import Model, Name

Row = Annotated[dict[str, str | bool | int], Field(min_length=1)]
Size = Annotated[float, Field(gt=0, lt=1e12)]


class Ratio(Model):
    """A number of a table over another of the same column."""

    table: Name = Field(description="a name in `tables`")
    column: str = Field(min_length=1, description="of the table's CSV")
    of: Row = Field(description="what finds its row: value by column")
    to: Row | Annotated[list[Row], Field(min_length=2)] | Size | None = Field(
        None,
        description="likewise, of what it is divided by, of several rows their mean; or a number; "
        "without it the sum of all others",
    )
    per: str | None = Field(
        None, min_length=1, description="a column of the table by which each is divided first"
    )
    unlearned: Size | None = Field(
        None,
        description="what `of` is of a network that learned nothing, where the table has no row of it",
    )
    at_least: float | None = Field(None, gt=0, lt=1e6, description="least ratio")
    at_most: float | None = Field(None, gt=0, lt=1e6, description="largest ratio")

    @model_validator(mode="after")
    def _check_bounds(self):
        if self.at_least is None and self.at_most is None:
            raise ValueError("a ratio needs `at_least`, `at_most`, or both")
        if self.per is not None and self.to is None:
            raise ValueError("a ratio to the sum of all others has no `per`")
        return self
