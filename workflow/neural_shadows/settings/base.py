"""Base model and field types of all sections."""

from collections.abc import Callable, Iterable
from difflib import get_close_matches
from functools import reduce
from operator import or_
from typing import Annotated, Any, NamedTuple

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationInfo,
    model_validator,
)
from pydantic_core import PydanticCustomError

MOST_LISTED = 20  # names in a message


class Model(BaseModel):
    """Base of all sections, without unknown keys or implicit conversions."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _check_keys(cls, values: Any) -> Any:
        for key in values if isinstance(values, dict) else ():
            if key not in cls.model_fields:
                # pydantic's own error does not list the allowed keys.
                context = {"key": not_among(str(key), cls.model_fields)}
                kind = cls.model_fields.get("kind")
                if kind and isinstance(kind.default, str):
                    context["key"] += f" (keys of `kind: {kind.default}`, the default)"
                raise PydanticCustomError("unknown_key", "unknown key: {key}", context)
        return values


def not_among(value: str, allowed: Iterable[str]) -> str:
    """Message about an unknown value, with suggestion and allowed values."""
    names = list(allowed)
    if len(names) > MOST_LISTED:  # its family first
        start = value.split("_")[0]
        names.sort(key=lambda name: not name.startswith(start))
    close = get_close_matches(value, names, 1)
    meant = f" (did you mean {close[0]!r}?)" if close else ""
    if not names:
        return f"{value!r} is not there: the configuration has none"
    return f"{value!r}{meant} is not among {_listed(names)}"


def _listed(names: list[str]) -> str:
    return ", ".join(names[:MOST_LISTED]) + (", …" if len(names) > MOST_LISTED else "")


def check_among(key: str, value: str, allowed: Iterable[str]) -> None:
    """Check that a key's value is allowed."""
    if value not in allowed:
        raise ValueError(f"{key}: {not_among(value, allowed)}")


def _power_of_two(value: int) -> int:
    if value & (value - 1):
        raise ValueError(f"{value} is not a power of two")
    return value


Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
Text = Annotated[str, Field(min_length=1)]
Seed = Annotated[int, Field(ge=0, lt=2**32)]
PowerOfTwo = Annotated[int, AfterValidator(_power_of_two)]


class EntryKind(NamedTuple):
    """Kind of a section's entries."""

    title: str  # as in "is not …"
    holds: Callable[[Any], bool]  # of an entry, as a dict or as a model


def of_another_kind(name: str, kind: EntryKind, allowed: Iterable[str]) -> str:
    """Message about an entry's name where one of a kind is needed."""
    return f"{name!r} is not {kind.title}. Allowed: {_listed(list(allowed))}"


def name_in(section: str, kind: EntryKind | None = None) -> Any:
    """Name of an entry of a section, of a kind, looked up in the context."""

    def check(name: str, info: ValidationInfo) -> str:
        entries = (info.context or {}).get(section)
        if not isinstance(entries, dict):
            return name
        if name in entries and (kind is None or kind.holds(entries[name])):
            return name
        allowed = [str(key) for key, entry in entries.items() if not kind or kind.holds(entry)]
        if name in entries:
            raise ValueError(of_another_kind(name, kind, allowed))
        raise ValueError(not_among(name, allowed))

    return Annotated[Name, AfterValidator(check)]


def has_key(value: Any, key: str) -> bool:
    """Check for a key of a section, as a dict or as a model."""
    return key in value if isinstance(value, dict) else hasattr(value, key)


def by_kind(key: str, *models: type[Model], default: str | None = None) -> Any:
    """Union of models, discriminated by one key."""
    union = Annotated[reduce(or_, models), Discriminator(key)]
    if default is None:
        return union
    return Annotated[
        union, BeforeValidator(lambda v: {key: default} | v if isinstance(v, dict) else v)
    ]


def text_or(text: Any, section: Any) -> Any:
    """Text, such as a name, or a section or number."""
    return Annotated[
        Annotated[text, Tag("Text")] | Annotated[section, Tag("Section")],
        Discriminator(lambda value: "Text" if isinstance(value, str) else "Section"),
    ]


def section_or(model: type[Model], key: str) -> Any:
    """A section, or the value of one key as text."""
    return Annotated[
        model,
        BeforeValidator(
            lambda value: {key: value} if isinstance(value, str) else value,
            json_schema_input_type=str | model,
        ),
    ]
