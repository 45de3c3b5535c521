"""The wording of what is wrong with a configuration."""

import reprlib
from typing import Any

from pydantic import ValidationError

from neural_shadows.config.whole import Config


def _describe(error: ValidationError) -> str:
    """One line for the first problem: key, value, and what is allowed."""
    problem = error.errors()[0]
    key, allowed = _locate(problem["loc"])
    message = problem["msg"].removeprefix("Value error, ")
    if problem["type"] == "extra_forbidden":
        message = f"unknown key; allowed: {', '.join(allowed)}"
    elif problem["type"] == "missing":
        message = "this key is missing"
    elif problem["type"] in ("dict_type", "model_type", "model_attributes_type"):
        message = f"should be a section of keys, not {_shown(problem['input'])}"
    elif problem["type"] == "float_type" and _is_number(problem["input"]):
        key = f"{key} = {_shown(problem['input'])}"
        message = "is text to YAML; write a number with a point, as 0.001 or 1.0e-3"
    elif problem["type"] != "value_error":  # our own checks name key and value themselves
        key = f"{key} = {_shown(problem['input'])}"
    more = error.error_count() - 1
    return f"{key + ': ' if key else ''}{message}" + (f" (and {more} more)" if more else "")


def _shown(value: Any) -> str:
    """A value as a message shows it: aliases of aliases in YAML may unfold to gigabytes."""
    shown = reprlib.Repr()
    shown.maxstring = shown.maxother = shown.maxlong = 80
    return shown.repr(value)


def _is_number(text: Any) -> bool:
    try:
        float(text)
    except (TypeError, ValueError):
        return False
    return True


TAGS = (
    "domain",
    "generate",
    "kind",
    "encoding",
)  # keys whose value tells which section of a union it is


def _locate(location: tuple[str | int, ...]) -> tuple[str, list[str]]:
    """The config key of an error's location, and the keys allowed in its section.

    pydantic's location also holds the tags of unions (`sphere`, `generate`), which are no
    keys: the schema tells the two apart. `[key]` at its end means the key itself.
    """
    schema = Config.model_json_schema()

    def resolve(node: dict) -> dict:
        return schema["$defs"][node["$ref"].rsplit("/", 1)[1]] if "$ref" in node else node

    node: dict = schema
    keys, allowed = [], []
    for part in location:
        if part == "[key]":
            break
        node = resolve(node)
        if "oneOf" in node:
            kinds = [resolve(kind) for kind in node["oneOf"]]
            kinds = [kind for kind in kinds if "properties" in kind]  # not a number or a word
            tagged = [
                kind
                for kind in kinds
                if part in kind["properties"]
                or part in (kind["properties"].get(key, {}).get("const") for key in TAGS)
            ]
            node = tagged[0] if tagged else {}
            continue
        keys.append(str(part))
        allowed = list(node.get("properties", {}))
        if part in allowed:
            node = node["properties"][part]
        elif isinstance(part, int):
            node = node.get("items", {})
        else:
            values = list(node.get("patternProperties", {}).values())
            node = values[0] if values else {}
    return ".".join(keys), allowed
