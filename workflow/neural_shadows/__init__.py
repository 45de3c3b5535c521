"""Methods for shadows, hard and soft, on the same frames; workflow/README.md has the rooms."""

import gc
import os
from importlib import import_module
from typing import Any

# A run's graph of jobs, and a job's imports, are millions of objects that stay: to search them for cycles
# took 6 % of planning and 8 % of imports. A job's own work has Python's threshold again.
GC_THRESHOLD = gc.get_threshold()
if "NEURAL_SHADOWS_COMMAND" in os.environ:
    gc.set_threshold(200_000, 20, 20)

# What the installed package is called for; workflow/field/README.md shows it. Imported when asked for: every
# module of the pipeline imports this one.
_HOMES = {
    "InputError": "neural_shadows.errors",
    "ShadowField": "neural_shadows.representations.shadow_field.shadow_field",
    "sky_patches": "neural_shadows.scenes.sky",
    "sun_directions": "neural_shadows.scenes.sky",
}
__all__ = ["InputError", "ShadowField", "sky_patches", "sun_directions"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
