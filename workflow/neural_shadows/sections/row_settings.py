"""Rows of tables of methods on scenes."""

from typing import Annotated, Literal

from pydantic import Field

from neural_shadows.settings.base import Model, Text, section_or


class RowSettings(Model):
    """Row with settings of its own."""

    method: str = Field(
        description="an experiment, a shadow map (`shadow_map_N`), `no_shadow`, or `ray_traced` in tables with times"
    )
    bias: Literal["held_out"] | None = Field(
        None,
        description="`held_out`: the best depth bias on held-out views, instead of the method's own",
    )
    label: Text | None = Field(None, description="label in the table; default: the method's")
    published: str | None = Field(None, description="key in published.csv, if not `method`")


Rows = Annotated[list[section_or(RowSettings, "method")], Field(min_length=1)]
