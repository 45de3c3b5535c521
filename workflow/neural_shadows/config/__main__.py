"""JSON schema of the configuration: `python -m neural_shadows.config`.

With `--markdown` the reference of its keys; with config files the first that cannot be read as YAML, and
where: Snakemake reads those of `--configfile` before all else, and names neither.
"""

import json
import sys
from typing import Any

from neural_shadows.config.whole import Config


def json_schema() -> str:
    """JSON schema of a config file, as in workflow/schemas.

    Files are merged before they are checked: no key is required in a single file, and every key may
    be null, by which an overlay removes it.
    """
    return json.dumps(_part(Config.model_json_schema()), indent=1, ensure_ascii=False) + "\n"


def _part(node: Any) -> Any:
    if isinstance(node, list):
        return [_part(item) for item in node]
    if not isinstance(node, dict):
        return node
    dropped = [("required", list), ("title", str)]  # `title` may also be a property, a dict
    part = {key: _part(value) for key, value in node.items() if (key, type(value)) not in dropped}
    if "oneOf" in part:  # without its kind a section may match several
        part["anyOf"] = part.pop("oneOf")
    for key in ("properties", "patternProperties"):
        if key in part:
            part[key] = {name: _or_null(value) for name, value in part[key].items()}
    return part


def _or_null(value: dict[str, Any]) -> dict[str, Any]:
    """A value's schema with null, in one level where that does."""
    null = {"type": "null"}
    if null in value.get("anyOf", ()):
        return value
    if "const" in value or "enum" in value:
        allowed = value.pop("enum", None) or [value.pop("const")]
        value.pop("type")  # follows from the values
        return value | {"enum": [*allowed, None]}
    if "type" in value:
        return value | {"type": [value["type"], "null"]}
    about = {"description": value.pop("description")} if "description" in value else {}
    return about | {"anyOf": [value, null]}


if __name__ == "__main__":
    if sys.argv[1:] == ["--markdown"]:
        from neural_shadows.config.reference import markdown

        print(markdown(), end="")
    elif sys.argv[1:]:
        from neural_shadows.config.reading import read_sections
        from neural_shadows.errors import InputError

        try:
            for path in sys.argv[1:]:
                read_sections(path)
        except InputError as error:
            sys.exit(str(error))
    else:
        print(json_schema(), end="")
