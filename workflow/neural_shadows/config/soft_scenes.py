"""`soft_scenes`: several objects in metres, lit by a light at a place."""

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from neural_shadows.config.base import Model, name_in
from neural_shadows.scenes.generators.registry import TRAINED, UNTRAINED

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


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


def layout_seed(config: "Config", name: str) -> int:
    """The seed that a scene's layout is drawn from."""
    seed = config.soft_scenes[name].seed
    return config.seed if seed is None else seed


def check(config: "Config") -> None:
    """Check that no object stands in a scene twice, and that only a plate's object can be raised."""
    for name, scene in config.soft_scenes.items():
        if len(set(scene.inserted)) < len(scene.inserted):
            raise ValueError(
                f"soft_scenes.{name}.inserted = {scene.inserted}: must name each only once"
            )
        if scene.penumbra is not None and (scene.generate != "plate" or len(scene.inserted) != 1):
            raise ValueError(
                f"soft_scenes.{name}.penumbra: needs `generate: plate` and one object `inserted`"
            )
