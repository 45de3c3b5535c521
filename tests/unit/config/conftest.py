"""The shipped configuration, changed in one place, and what is said about that."""

import copy
import functools
from pathlib import Path

import pytest
import yaml

from neural_shadows.config.reading import read_config
from neural_shadows.errors import InputError


@functools.cache
def shipped_file(name):
    path = Path(__file__).parents[3] / "config" / f"{name}.yaml"
    return yaml.load(path.read_text(), getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def merge(base, overlay):
    """As Snakemake merges files: sections are merged, all else is replaced."""
    for key, value in overlay.items():
        if isinstance(value, dict) and isinstance(base.get(key), dict):
            merge(base[key], value)
        else:
            base[key] = copy.deepcopy(value)
    return base


@pytest.fixture(scope="session")
def shipped():
    """A function: the default's values with those of an overlay."""
    return lambda name="config": functools.reduce(
        merge, map(shipped_file, ("config", "reports", name)), {}
    )


@pytest.fixture
def values(shipped):
    return shipped()


@pytest.fixture
def changed(values):
    """A function: the values with the one at `key` (`rendering.width`, `rows.0.label`) set."""

    def change(key, value):
        *sections, last = [int(part) if part.isdigit() else part for part in key.split(".")]
        functools.reduce(lambda section, part: section[part], sections, values)[last] = value
        return values

    return change


@pytest.fixture
def message(changed):
    """A function: what is said about a mistake at a key, or about whole values."""

    def say(key, value=None):
        with pytest.raises(InputError) as caught:
            read_config(key if isinstance(key, dict) else changed(key, value))
        text = str(caught.value)
        assert text.startswith("config: ") and "\n" not in text
        assert "more)" not in text  # one mistake is reported as one
        return text.removeprefix("config: ")

    return say
