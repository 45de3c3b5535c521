"""`soft_scenes`: generated scenes in metres, lit by a sphere."""

from typing import Literal

from pydantic import Field

from neural_shadows.scenes.generators.registry import TRAINED, UNTRAINED
from neural_shadows.settings.base import Model, name_in


class SoftScene(Model):
    """Generated scene with inserted objects of `scenes`."""

    generate: Literal[TRAINED + UNTRAINED] = Field(
        description="generator of the scene, a file in workflow/neural_shadows/scenes/generators/"
    )
    inserted: list[name_in("scenes")] = Field(
        [],
        description="names in `scenes`; their meshes are placed on the scene's spots in this order",
    )
    seed: int | None = Field(None, ge=0, description="seed of the layout; default: the global seed")
    penumbra: float | None = Field(
        None,
        gt=0,
        le=1000,
        description="for `plate` only: sets the object's height by the 95th percentile of penumbra widths, in "
        "pixels of a 512² frame at 45° under a light of 0.25 m, by Neural Shadow Mapping's model",
    )
