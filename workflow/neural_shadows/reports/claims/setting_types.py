"""Types of settings of several kinds of claims."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Field, model_validator

from neural_shadows.reports.claims.measured import Claim
from neural_shadows.settings.base import Model, Name

Radius = Annotated[int, Field(ge=0)]  # its number


def _check_once(values: list[Any]) -> list[Any]:
    for value in values:
        if values.count(value) > 1:
            raise ValueError(f"{value!r} is listed twice. List it once")
    return values


def _check_each_once(counterparts: dict[str, list[str]]) -> dict[str, list[str]]:
    for name, others in counterparts.items():
        _check_once([name, *others])
    return counterparts


def _check_unlike(pair: list[str]) -> list[str]:
    if pair[0] == pair[1]:
        raise ValueError(f"{pair[0]!r} is compared with itself. Name two methods")
    return pair


_Pair = Annotated[list[str], Field(min_length=2, max_length=2), AfterValidator(_check_unlike)]
Pairs = Annotated[list[_Pair], Field(min_length=1)]


def metrics(*names: str) -> Any:
    """A list of these metrics, each at most once."""
    return Annotated[list[Literal[names]], Field(min_length=1), AfterValidator(_check_once)]


def again(name: Any) -> Any:
    """Counterparts from other seeds by name, each once."""
    return Annotated[dict[Name, list[name]], AfterValidator(_check_each_once)]


class Bounded(Model):
    """A ratio within bounds."""

    bounded: ClassVar[str]  # in messages

    at_least: float | None = Field(None, gt=0, lt=1e6, description="least ratio")
    at_most: float | None = Field(None, gt=0, lt=1e6, description="largest ratio")

    @model_validator(mode="after")
    def _check_bounds(self):
        if self.at_least is None and self.at_most is None:
            raise ValueError(f"{self.bounded} needs `at_least`, `at_most`, or both")
        return self


def bounds_of(ratio: Claim) -> dict[str, float]:
    """The bounds of a ratio, by key."""
    return {key: ratio[key] for key in ("at_least", "at_most") if ratio[key] is not None}


def in_words(bounds: dict[str, float]) -> str:
    """Bounds in words."""
    return " and ".join(f"{key.replace('_', ' ')} {bound:g}" for key, bound in bounds.items())
