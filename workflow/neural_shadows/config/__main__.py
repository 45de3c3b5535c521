"""Print the JSON schema for editors of YAML: `python -m neural_shadows.config`."""

import json
from typing import Any

from neural_shadows.config.whole import Config


def json_schema() -> str:
    """The JSON schema of a config file, as checked in under workflow/schemas.

    Each file is a part of the whole, merged with the others before it is checked: so no key is
    required here, and every key may be null, by which an overlay drops it.
    """
    return json.dumps(_part(Config.model_json_schema()), indent=1, ensure_ascii=False) + "\n"


def _part(node: Any) -> Any:
    if isinstance(node, list):
        return [_part(one) for one in node]
    if not isinstance(node, dict):
        return node
    part = {}
    for key, value in node.items():
        match key:
            case "required" | "title" | "default":
                pass
            case "properties" | "patternProperties":
                part[key] = {name: _or_null(_part(one)) for name, one in value.items()}
            case "$defs":
                part[key] = {name: _part(one) for name, one in value.items()}
            case "oneOf":  # without its kind a section may be of several
                part["anyOf"] = _part(value)
            case _:
                part[key] = _part(value)
    return part


def _or_null(schema: dict[str, Any]) -> dict[str, Any]:
    description = {key: schema.pop(key) for key in ("description",) if key in schema}
    null = {"type": "null"}
    if null in schema.get("anyOf", []):
        return description | schema
    return description | {"anyOf": [schema, null]}


if __name__ == "__main__":
    print(json_schema(), end="")
