"""`soft_scenes`: several objects in metres, lit by a light at a place."""

from typing import Literal

from pydantic import Field

from neural_shadows.scenes.generators.registry import TRAINED, UNTRAINED
from neural_shadows.settings.base import Model, name_in


class SoftScene(Model):
    """A generated scene, and objects of `scenes` that stand in it."""

    generate: Literal[TRAINED + UNTRAINED] = Field(
        description="a file in workflow/neural_shadows/scenes/generators/"
    )
    inserted: list[name_in("scenes")] = Field(
        [], description="names in `scenes`, whose meshes stand on the scene's spots in this order"
    )
    seed: int | None = Field(
        None, ge=0, description="that its layout is drawn from; default: the run's"
    )
    penumbra: float | None = Field(
        None,
        gt=0,
        le=1000,
        description="of a plate: the 95th percentile of its penumbrae's widths in pixels of a frame "
        "of 512² at 45°, lit by 0.25 m, by Neural Shadow Mapping's model; its object is as high",
    )
