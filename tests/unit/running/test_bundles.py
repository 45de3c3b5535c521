from dataclasses import dataclass

from neural_shadows.running.bundles import argument_types, call, required


@dataclass(frozen=True, kw_only=True)
class Bundle:
    first: int
    second: str = "default"


def function(bundle: Bundle, alone: float, optional: bool = False):
    return bundle, alone, optional


def test_a_dataclass_stands_for_its_fields():
    types = {"first": int, "second": str, "alone": float, "optional": bool}
    assert argument_types(function) == types
    assert required(function) == ["first", "alone"]


def test_a_call_bundles_what_is_named_and_drops_what_is_not():
    values = {"first": 1, "alone": 0.5, "other": None}
    assert call(function, values) == (Bundle(first=1), 0.5, False)
    assert call(function, values | {"second": "b", "optional": True})[::2] == (
        Bundle(first=1, second="b"),
        True,
    )
