"""What all sections of the configuration share."""

from collections.abc import Callable, Iterable
from difflib import get_close_matches
from functools import reduce
from operator import or_
from typing import Annotated, Any, get_args

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    model_validator,
)
from pydantic_core import PydanticCustomError

Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
Seed = Annotated[int, Field(ge=0, lt=2**32)]


class Model(BaseModel):
    """Base of all sections: unknown keys are refused, values are not converted silently."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _check_keys(cls, values: Any) -> Any:
        for key in values if isinstance(values, dict) else ():
            if key not in cls.model_fields:
                # pydantic's own error does not say which keys there are.
                told = {"key": not_among(str(key), cls.model_fields)}
                raise PydanticCustomError("unknown_key", "unknown key: {key}", told)
        return values


def not_among(value: str, allowed: Iterable[str]) -> str:
    """What is wrong with a value, what is allowed, and what was probably meant."""
    names = list(allowed)
    close = get_close_matches(value, names, 1)
    meant = f" (did you mean {close[0]!r}?)" if close else ""
    more = ", …" if len(names) > 20 else ""
    return f"{value!r}{meant} is not among {', '.join(names[:20])}{more}"


def check_among(key: str, value: str, allowed: Iterable[str]) -> None:
    """Check that what stands at a key is one of the names that it may be."""
    if value not in allowed:
        raise ValueError(f"{key}: {not_among(value, allowed)}")


def check_power_of_two(value: int, key: str) -> None:
    """Check that the value of a key is a power of two."""
    if value & (value - 1):
        raise ValueError(f"{key} = {value}: must be a power of two")


def one_of(models: Iterable[type[Model]], tag: Callable[[dict], str | None], message: str) -> Any:
    """The union of models, of which a function tells the one that a section is of.

    Tags are the classes' names, which no key of the configuration can be: messages leave out
    what is no key from the place of an error.
    """
    return Annotated[
        reduce(or_, (Annotated[model, Tag(model.__name__)] for model in models)),
        Discriminator(
            lambda value: tag(value) if isinstance(value, dict) else type(value).__name__,
            custom_error_type="one_of",
            custom_error_message=message,
        ),
    ]


def by_kind(key: str, *models: type[Model], default: str | None = None) -> Any:
    """The union of models that the value of one key tells apart."""
    tags = {
        kind: model.__name__
        for model in models
        for kind in get_args(model.model_fields[key].annotation)
    }
    message = f"`{key}` should be one of {', '.join(tags)}"
    return one_of(models, lambda section: tags.get(str(section.get(key, default))), message)


def name_or(section: Any) -> Any:
    """A name that refers to a section, or the section itself."""
    return Annotated[
        Annotated[Name, Tag("Name")] | Annotated[section, Tag("Section")],
        Discriminator(lambda value: "Name" if isinstance(value, str) else "Section"),
    ]


def section_or(model: type[Model], key: str) -> Any:
    """A section, or only the value of its first key."""
    return Annotated[
        model,
        BeforeValidator(
            lambda value: {key: value} if isinstance(value, str) else value,
            json_schema_input_type=str | model,
        ),
    ]
