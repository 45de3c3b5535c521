"""What all sections of the configuration share."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]


class Model(BaseModel):
    """Base of all sections: unknown keys are refused, values are not converted silently."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


def _check_power_of_two(value: int, key: str) -> None:
    if value & (value - 1):
        raise ValueError(f"{key} = {value}: must be a power of two")


ON_REQUEST = Field(
    False, description="whether it is made only when asked for by name, and not by `all`"
)
