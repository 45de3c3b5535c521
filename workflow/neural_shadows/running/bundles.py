"""Functions whose arguments come in bundles: dataclasses."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from typing import Any


def argument_types(function: Callable[..., Any]) -> dict[str, Any]:
    """Types of a function's arguments; of a dataclass, those of its fields."""
    types: dict[str, Any] = {}
    for parameter in inspect.signature(function).parameters.values():
        kind = parameter.annotation
        if is_dataclass(kind):
            types |= {field.name: field.type for field in fields(kind) if field.init}
        else:
            types[parameter.name] = kind
    return types


def required(function: Callable[..., Any]) -> list[str]:
    """Arguments of `argument_types` without a default."""
    names = []
    for parameter in inspect.signature(function).parameters.values():
        kind = parameter.annotation
        if is_dataclass(kind):
            names += [field.name for field in fields(kind) if _is_required(field)]
        elif parameter.default is parameter.empty:
            names.append(parameter.name)
    return names


def _is_required(field: Field) -> bool:
    return field.init and field.default is MISSING and field.default_factory is MISSING


def call(function: Callable[..., Any], values: Mapping[str, Any]) -> Any:
    """Call a function with the values that it names, bundled into its dataclasses."""
    arguments = {}
    for name, parameter in inspect.signature(function).parameters.items():
        if is_dataclass(kind := parameter.annotation):
            of_bundle = (field.name for field in fields(kind) if field.init)
            arguments[name] = kind(**{key: values[key] for key in of_bundle if key in values})
        elif name in values:
            arguments[name] = values[name]
    return function(**arguments)
