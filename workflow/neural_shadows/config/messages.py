"""Error messages about a configuration."""

import re
import reprlib
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_FIRST_KEY = re.compile(r"(?:(?!unknown key)(\w+(?:\.\w+)*)(?:: | = ))?(?:unknown key: '(\w+)')?")
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
        case "float_type" | "int_type" if _is_number(problem["input"]):
            key = f"{key} = {_shown(problem['input'])}"
            message = (
                "is text, not a number. In a file write it without quotes, and with a point, as 1.0e-3; "
                "in braces after `--config` all is text: use an overlay"
            )
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


def _is_number(value: Any) -> bool:
    return isinstance(value, str) and _NUMBER.match(value) is not None


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


def place_of(message: str, files: Iterable[str | Path], values: Any) -> str:
    """File and line of a message's first key, as ` [config/mine.yaml, line 7]`.

    Empty for a value of the command line.

    Args:
        message: begins with the key. files: in the order of merging. values: the merged ones.
    """
    path, unknown = _FIRST_KEY.match(message).groups()
    keys = [key for key in [*(path or "").split("."), unknown] if key]
    depth, place, overridden = 0, "", False
    for file in files:
        path = Path(file)
        with path.open(encoding="utf-8") as content:
            matched, line = _depth(yaml.compose(content, LOADER), keys, values)
        overridden |= matched is None
        if matched and matched >= depth:
            depth, place = matched, f" [{_relative(path)}, line {line}]"
    return "" if overridden and depth < len(keys) else place


def _relative(path: Path) -> Path:
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


def _depth(node: yaml.Node | None, keys: Sequence[str], values: Any) -> tuple[int | None, int]:
    """Depth of the keys below a node, and line of the last; None where another value counts."""
    depth, line = 0, 0
    for key in keys:
        if isinstance(node, yaml.MappingNode):
            below = {k.value: (k, v) for k, v in node.value}
        elif isinstance(node, yaml.SequenceNode):
            below = {str(index): (item, item) for index, item in enumerate(node.value)}
        else:
            break
        if key not in below or not isinstance(values, dict | list):
            break
        name, node = below[key]
        values = values[int(key)] if isinstance(values, list) else values.get(key)
        depth, line = depth + 1, name.start_mark.line + 1
    if isinstance(node, yaml.ScalarNode) and not isinstance(values, dict | list):
        same = yaml.safe_load(yaml.serialize(node)) == values
        return (depth, line) if same else (None, 0)
    return depth, line


def _shown(value: Any) -> str:
    """A shortened value: nested YAML aliases may expand to gigabytes."""
    shown = reprlib.Repr()
    shown.maxstring = shown.maxother = shown.maxlong = 80
    return shown.repr(value)
