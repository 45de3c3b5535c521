"""`experiments`: the networks that are trained."""

from typing import Annotated, Literal

from pydantic import Field

from neural_shadows.sections.networks import Network
from neural_shadows.sections.trainings import Training
from neural_shadows.settings.base import Model, Seed, Text, name_in, text_or


class Experiment(Model):
    """One network: scene + network, and sampling + training of one that is trained."""

    scene: name_in("scenes") = Field(description="a name in `scenes`")
    sampling: name_in("samplings") | None = Field(
        None, description="a name in `samplings`; none for a network that is only built"
    )
    network: text_or(name_in("networks"), Network) = Field(description="a name, or a section")
    training: text_or(name_in("trainings"), Training) | None = Field(
        None, description="a name, or a section; none for a network that is only built"
    )
    seed: Seed | None = Field(None, description="seed of this training; without it the scene's")
    bias: text_or(Literal["held_out"], Annotated[float, Field(ge=0, le=1)]) = Field(
        0.0, description="added to t_pred, in radii; `held_out`: the best on views in no table"
    )
    label: Text | None = Field(
        None, description="its name in tables; may hold settings, as `{resolution}³ field`"
    )
