"""A row of a table of methods on a scene, as the configuration has it."""

from typing import Annotated, Literal

from pydantic import Field

from neural_shadows.settings.base import Model, Text, section_or


class RowSettings(Model):
    """A row of a table that is more than a name."""

    method: str = Field(
        description="an experiment, a map (`shadow_map_N`), `no_shadow`, or `ray_traced` if timed"
    )
    bias: Literal["held_out"] | None = Field(
        None, description="the depth bias that is best on held-out views, for the method's own"
    )
    label: Text | None = Field(None, description="without it the method's own label")
    published: str | None = Field(None, description="its key in published.csv, if not `method`")


Rows = Annotated[list[section_or(RowSettings, "method")], Field(min_length=1)]
