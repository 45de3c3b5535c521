"""`experiments`: networks on rays, one training each."""

from typing import Annotated, Literal

from pydantic import Field

from neural_shadows.sections.networks import Network
from neural_shadows.sections.trainings import Training
from neural_shadows.settings.base import Model, Seed, Text, name_in, text_or


class Experiment(Model):
    """One network: scene, architecture, training rays, training, seed."""

    scene: name_in("scenes") = Field(description="a name in `scenes`")
    sampling: name_in("samplings") | None = Field(
        None, description="a name in `samplings`; omitted for a network without training"
    )
    network: text_or(name_in("networks"), Network) = Field(
        description="name in `networks`, or section"
    )
    training: text_or(name_in("trainings"), Training) | None = Field(
        None,
        description="a name in `trainings`, or a section; omitted for a network without training",
    )
    seed: Seed | None = Field(None, description="seed of the training; default: the scene's")
    bias: text_or(Literal["held_out"], Annotated[float, Field(ge=0, le=1)]) = Field(
        0.0,
        description="depth bias added to t_pred, in sphere radii; `held_out`: the best on held-out views",
    )
    label: Text | None = Field(
        None,
        description="label in tables; may contain settings in braces, such as `{resolution}³ field`",
    )
