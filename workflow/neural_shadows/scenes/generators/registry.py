"""Names and modules of scene generators."""

from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.errors import InputError

if TYPE_CHECKING:  # the graph uses names only
    from neural_shadows.scenes.arrangement import Arrangement

TRAINED = ("room", "atrium", "hall", "classroom", "gallery", "plate")
UNTRAINED = ("garden", "workshop", "stairs", "blinds", "tree", "interior", "court")


def generator_module(name: str) -> Path:
    """Path of a generator's module: `room.py` for `room`."""
    return Path(__file__).with_name(f"{name}.py")


def generator(name: str) -> ModuleType:
    """Module of a generator.

    Imported by name, so that a result depends on its own generators only."""
    return import_module(f"neural_shadows.scenes.generators.{name}")


def arrange(name: str, seed: int) -> "Arrangement":
    """Draw a scene's arrangement from a seed.

    Raises:
        InputError: the generator is unknown.
    """
    if name not in TRAINED + UNTRAINED:
        raise InputError(
            f"{name!r} is not a generator. Use one of {', '.join(TRAINED + UNTRAINED)}"
        )
    return generator(name).arrange(np.random.default_rng(seed))
