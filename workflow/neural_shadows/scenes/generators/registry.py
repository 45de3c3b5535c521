"""Which scenes there are, and where the module of each lies."""

from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.errors import InputError

if TYPE_CHECKING:  # the graph asks for names alone
    from neural_shadows.scenes.arrangement import Arrangement

TRAINED = ("room", "atrium", "hall", "classroom", "gallery", "plate")
UNTRAINED = ("garden", "workshop", "stairs", "blinds", "tree", "interior", "court")


def generator_module(name: str) -> Path:
    """The module of a scene: `room.py` for `room`."""
    return Path(__file__).with_name(f"{name}.py")


def generator(name: str) -> ModuleType:
    """That module, imported by its name: a result depends on its own scenes' alone."""
    return import_module(f"neural_shadows.scenes.generators.{name}")


def arrange(name: str, seed: int) -> "Arrangement":
    """A scene's arrangement, drawn from a seed.

    Raises:
        InputError: there is no such scene.
    """
    if name not in TRAINED + UNTRAINED:
        raise InputError(f"{name!r} is no scene; use one of {', '.join(TRAINED + UNTRAINED)}")
    return generator(name).arrange(np.random.default_rng(seed))
