"""What all tables of `tables` have."""

from pydantic import Field

from neural_shadows.config.base import Model, name_in


class AnyTable(Model):
    """What all tables have."""

    title: str = Field(min_length=1, description="heading of the table")
    published: str | None = Field(
        None, pattern=r"^4\.[1-7]$", description="the thesis's number of this table"
    )
    figures: list[name_in("figures")] = Field([], description="made and shown beside the table")
    on_request: bool = Field(False, description="made only when asked for by name")
