"""The shipped files: valid, with every key of use, and as the schema for editors says."""

import json
import re
from pathlib import Path

import jsonschema
import pytest
import yaml
from pydantic import BaseModel

from neural_shadows.config.__main__ import json_schema
from neural_shadows.config.base import Model
from neural_shadows.config.reading import check_duplicates, read_config
from neural_shadows.config.resolved import resolved

ROOT = Path(__file__).parents[3]
FILES = sorted((ROOT / "config").glob("*.yaml"))
SCHEMA = ROOT / "workflow" / "schemas" / "config.schema.json"
# What is given on the command line, as config/README.md shows.
BY_HAND = {("Config", "dragon"), ("DownloadedMesh", "download"), ("LpipsTrunk", "trunk")}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_shipped_files_are_valid(shipped, path, recwarn):
    resolved(read_config(shipped(path.stem)))
    check_duplicates([path])
    assert path.read_text().startswith("# yaml-language-server: $schema=../workflow/schemas/")
    jsonschema.validate(yaml.safe_load(path.read_text()), json.loads(SCHEMA.read_text()))
    assert not recwarn.list


def test_every_key_is_reached(shipped):
    def owner(model, key):
        """The first class that has a key, of a class that inherits it."""
        return next(
            c.__name__
            for c in reversed(model.__mro__)
            if key in c.__dict__.get("__annotations__", {})
        )

    def keys(value):
        if isinstance(value, BaseModel):
            yield from ((owner(type(value), key), key) for key in value.model_fields_set)
            value = {key: getattr(value, key) for key in value.model_fields_set}
        for part in value.values() if isinstance(value, dict) else value:
            if isinstance(part, BaseModel | dict | list):
                yield from keys(part)

    used = {key for path in FILES for key in keys(read_config(shipped(path.stem)))}
    there = {
        (owner(model, key), key)
        for model in subclasses(Model)
        for key in model.model_fields
        if key not in ("kind", "encoding")
    }
    assert there - used == BY_HAND


def test_examples_of_the_readme_are_valid(shipped):
    text = (ROOT / "config" / "README.md").read_text(encoding="utf-8")
    examples = re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)
    values = shipped()
    for example in examples:
        for section, entries in yaml.safe_load(example).items():
            values[section] = values[section] | entries if isinstance(entries, dict) else entries
    assert (
        len(examples) == 3
        and {"teapot", "dragon_small"} <= resolved(read_config(values))["experiments"].keys()
    )


def subclasses(model):
    """All sections, each once."""
    for one in model.__subclasses__():
        yield one
        yield from subclasses(one)


def test_schema_is_checked_in():
    assert SCHEMA.read_text(encoding="utf-8") == json_schema(), (
        "make it again: PYTHONPATH=workflow python -m neural_shadows.config "
        "> workflow/schemas/config.schema.json"
    )


@pytest.mark.parametrize("model", list(subclasses(Model)), ids=lambda model: model.__name__)
def test_every_key_is_described_and_bounded(model):
    schema = model.model_json_schema()
    assert schema["description"] and not schema["description"].startswith("Base of")
    for key, field in schema["properties"].items():
        assert field.get("description"), f"{key} has no description"
        if field.get("type") in ("integer", "number"):
            assert field.keys() & {"minimum", "exclusiveMinimum"}, f"{key}: no range"


@pytest.mark.parametrize("part", [{"sceens": {}}, {"networks": {"mine": {"encoding": "wave"}}}])
def test_schema_refuses(part):
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(part, json.loads(SCHEMA.read_text()))
