"""Error messages about a configuration."""

import re
import reprlib
from typing import Any

from pydantic import ValidationError

_NUMBER = re.compile(r"[-+.\d]+(e[-+]?\d+)?$", re.IGNORECASE)


def describe(error: ValidationError, values: Any) -> str:
    """Line on the first problem: key, value, allowed values.

    Args:
        values: the checked values; they distinguish keys in a problem's path from tags of unions.
    """
    # A default computed from other keys fails where those are wrong.
    problems = [p for p in error.errors() if p["type"] != "default_factory_not_called"]
    problem, more = problems[0], len(problems) - 1
    key = _key(problem, values)
    message = problem["msg"].removeprefix("Value error, ")
    match problem["type"]:
        case "missing":
            message = "this key is missing"
        case "dict_type" | "model_type" | "model_attributes_type":
            message = f"should be a section of keys, not {_shown(problem['input'])}"
        case "float_type" if isinstance(problem["input"], str) and _NUMBER.match(problem["input"]):
            key = f"{key} = {_shown(problem['input'])}"
            message = "is text to YAML; write a number with a point, as 0.001 or 1.0e-3"
        case "union_tag_not_found":
            message = f"the key {problem['ctx']['discriminator']} is missing"
        case "union_tag_invalid":
            kind = problem["ctx"]["discriminator"].strip("'")
            key = f"{key}.{kind} = {_shown(problem['input'][kind])}"
            message = f"should be one of {problem['ctx']['expected_tags']}"
        case "value_error" | "unknown_key":  # these name key and value themselves
            pass
        case _:
            key = f"{key} = {_shown(problem['input'])}"
    return f"{key + ': ' if key else ''}{message}" + (f" (and {more} more)" if more else "")


def _key(problem: Any, values: Any) -> str:
    """Config key of a problem, without tags of unions."""
    keys = []
    for part in problem["loc"]:
        is_key = isinstance(values, dict) and part in values
        is_index = isinstance(values, list) and isinstance(part, int)
        if is_key or is_index:
            values = values[part]
            keys.append(str(part))
    if problem["type"] == "missing":
        keys.append(str(problem["loc"][-1]))
    return ".".join(keys)


def _shown(value: Any) -> str:
    """A shortened value: nested YAML aliases may expand to gigabytes."""
    shown = reprlib.Repr()
    shown.maxstring = shown.maxother = shown.maxlong = 80
    return shown.repr(value)
