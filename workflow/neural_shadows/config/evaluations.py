"""`evaluations`: what is rendered on the viewpoints of a scene."""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from neural_shadows.config.base import Model, Name

# Two types of one value; told apart beforehand, a mistake is told as one of its type alone.
DepthBias = Annotated[
    Annotated[float, Field(ge=0, le=1), Tag("number")]
    | Annotated[Literal["held_out"], Tag("word")],
    Discriminator(lambda value: "word" if isinstance(value, str) else "number"),
]


class Evaluation(Model):
    """Methods compared with the reference on the viewpoints of one scene [4.1]."""

    scene: Name = Field(description="a name in `scenes`")
    networks: list[Name] = Field(
        min_length=1, description="experiments whose networks are rendered"
    )
    shadow_maps: list[Annotated[int, Field(ge=2, le=32768)]] = Field(
        [2048, 1024, 512, 256, 128], description="resolutions of the shadow maps"
    )
    view_sets: list[Literal["shadow", "surface", "centre"]] = Field(
        ["shadow", "surface"],
        min_length=1,
        description="`shadow`: aimed at the cast shadow; `surface`: at the object; `centre`",
    )
    depth_bias: DepthBias = Field(
        0.0,
        description=(
            "added to t_pred in the query, in sphere radii (thesis: 0); `held_out`: each network's "
            "best on views that are in no table, where its method is called NAME_biased"
        ),
    )

    @model_validator(mode="after")
    def _check(self):
        for key in ("networks", "shadow_maps", "view_sets"):
            values = getattr(self, key)
            if len(set(values)) < len(values):
                raise ValueError(f"{key} = {values}: must name each only once")
        return self
