"""Generated scenes: a module of `generators` each, found by its name."""

from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # the graph uses names only
    from neural_shadows.scenes.arrangement import Arrangement

_FOLDER = Path(__file__).with_name("generators")


def generator_names() -> list[str]:
    """Names of all generators: of the folder's files."""
    return sorted(path.stem for path in _FOLDER.glob("[a-z]*.py"))


def generator_module(name: str) -> Path:
    """Path of a generator's module: `room.py` for `room`."""
    return _FOLDER / f"{name}.py"


def generator(name: str) -> ModuleType:
    """Module of a generator.

    Imported by name, so that a result depends on its own generators only."""
    return import_module(f"neural_shadows.scenes.generators.{name}")


def arrange(name: str, seed: int | list[int]) -> "Arrangement":
    """Draw a scene's arrangement from a seed, see `numpy.random.default_rng`."""
    return generator(name).arrange(np.random.default_rng(seed))
