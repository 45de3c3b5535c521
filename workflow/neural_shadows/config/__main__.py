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
    dropped = [("required", list), ("title", str)]  # `title` may also be a property, a dict
    part = {key: _part(value) for key, value in node.items() if (key, type(value)) not in dropped}
    if "oneOf" in part:  # without its kind a section may be of several
        part["anyOf"] = part.pop("oneOf")
    for key in ("properties", "patternProperties"):
        for name, value in part.get(key, {}).items():
            about = {"description": value.pop("description")} if "description" in value else {}
            part[key][name] = about | {"anyOf": [value, {"type": "null"}]}
    return part


if __name__ == "__main__":
    print(json_schema(), end="")
