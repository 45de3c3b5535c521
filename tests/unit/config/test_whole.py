"""The shipped files: valid, and as the schema for editors says."""

import inspect
import json
import re
import shlex
from functools import cache
from pathlib import Path

import jsonschema
import pytest
import yaml
from checkout import ROOT
from shipped import shipped
from snakemake.cli import get_argument_parser
from snakemake.utils import update_config

from neural_shadows.config.__main__ import json_schema
from neural_shadows.config.reading import read_config, read_sections
from neural_shadows.config.reference import markdown
from neural_shadows.config.resolved import resolved
from neural_shadows.sections.own_frames import EngineFrames
from neural_shadows.settings.base import Model

FILES = sorted((ROOT / "config").glob("*.yaml"))
config_of = cache(lambda name: read_config(shipped(name)))
REFERENCE = ROOT / "config" / "REFERENCE.md"
SCHEMA = ROOT / "workflow" / "schemas" / "config.schema.json"


@pytest.fixture(scope="module")
def validator():
    """Of the checked schema, which takes 1.5 s: once."""
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    kind = jsonschema.validators.validator_for(schema)
    kind.check_schema(schema)
    return kind(schema)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_shipped_files_are_valid(path, validator, recwarn):
    resolved(config_of(path.stem))
    read_sections(path)
    assert path.read_text().startswith("# yaml-language-server: $schema=../workflow/schemas/")
    validator.validate(yaml.safe_load(path.read_text()))
    assert not recwarn.list


def subclasses(model):
    return {model}.union(*map(subclasses, model.__subclasses__()))


def test_every_key_is_of_use_to_a_shipped_file():
    def given(part):
        if isinstance(part, Model):
            parents = type(part).__mro__
            yield from ((model, key) for key in part.model_fields_set for model in parents)
            part = dict(part)
        for one in part.values() if isinstance(part, dict) else part:
            if isinstance(one, Model | dict | list):
                yield from given(one)

    used = {key for path in FILES for key in given(config_of(path.stem))}
    ours = [m for m in subclasses(Model) if (ROOT / "workflow") in Path(inspect.getfile(m)).parents]
    there = [(m, key) for m in ours for key in inspect.get_annotations(m)]
    unused = {key for m, key in there if key in m.model_fields and (m, key) not in used}
    unused -= {"weights", "sha256"}  # taken out while networks are trained anew
    # Given on the command line; frames of a user's own.
    assert unused == {"trunk", "path", "up", "only", "engine", *EngineFrames.model_fields}


def test_commands_name_their_targets_first():
    """Snakemake takes what follows `--configfile`, `--config` or `--resources` for more of these."""
    folders = [ROOT, ROOT / "config", ROOT / "workflow" / "profiles" / "slurm"]
    texts = [path for folder in folders for path in folder.glob("*.md")]
    commands = [
        command
        for path in [*texts, *(ROOT / "config").glob("*.yaml")]
        for line in path.read_text(encoding="utf-8").replace("\\\n", "").splitlines()
        for command in re.findall(r"snakemake ((?:--|[A-Z]|re)[^`#|;…]*(?=$|[`#|;]))", line)
    ]
    assert len(commands) > 50
    parser = get_argument_parser()
    for command in commands:
        options = parser.parse_args(shlex.split(command))
        assert all(path.suffix == ".yaml" for path in options.configfile or []), command


def test_examples_of_the_readme_are_valid():
    """But for the one of kinds that its own files define, see tests/workflow/test_own_kinds.py."""
    text = (ROOT / "config" / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)
    examples = [yaml.safe_load(one) for one in blocks if "# config/own.yaml" not in one]
    values = shipped()
    for example in examples:
        update_config(values, example)
    experiments = resolved(read_config(values))["experiments"]
    assert len(examples) == 13 and {"teapot", "dragon_small"} <= experiments.keys()


def test_reference_is_checked_in():
    assert REFERENCE.read_text(encoding="utf-8") == markdown(), (
        "make it again: PYTHONPATH=workflow python -m neural_shadows.config --markdown "
        "> config/REFERENCE.md"
    )


def test_schema_is_checked_in():
    assert SCHEMA.read_text(encoding="utf-8") == json_schema(), (
        "make it again: PYTHONPATH=workflow python -m neural_shadows.config "
        "> workflow/schemas/config.schema.json"
    )


def test_every_key_is_described_and_bounded():
    for model in subclasses(Model) - {Model}:
        schema = model.model_json_schema()
        assert schema["description"] and not schema["description"].startswith("Base of"), model
        for key, field in schema["properties"].items():
            assert field.get("description"), f"{model}: {key} has no description"
            if field.get("type") in ("integer", "number"):
                bounds = {"minimum", "exclusiveMinimum", "enum"}
                assert field.keys() & bounds, f"{model}: {key}: no range"
