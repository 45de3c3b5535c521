"""The shipped configuration, changed in one place, and what is said about that."""

import functools

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.errors import InputError


@pytest.fixture
def values():
    return shipped()


@pytest.fixture
def changed(values):
    """A function: the values with the one at `key` (as `rows.0.label`) set."""

    def change(key, value):
        *sections, last = [int(part) if part.isdigit() else part for part in key.split(".")]
        functools.reduce(lambda section, part: section[part], sections, values)[last] = value
        return values

    return change


@pytest.fixture
def message(changed):
    """A function: what is said about a mistake at a key, or about whole values."""

    def say(key, value=None):
        with pytest.raises(InputError, match=r"^config: [^\n]*$") as caught:
            read_config(key if isinstance(key, dict) else changed(key, value))
        assert "more)" not in str(caught.value)  # one mistake is reported as one
        return str(caught.value).removeprefix("config: ")

    return say
