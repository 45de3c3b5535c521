"""`screen_experiments`: the networks of whole frames that are trained."""

from typing import Annotated

from pydantic import Field

from neural_shadows.sections.networks import ScreenNetwork
from neural_shadows.sections.screen_trainings import ScreenTraining
from neural_shadows.settings.base import Model, Seed, Text, name_in, text_or


class ScreenExperiment(Model):
    """One network: its shape, its training, and the frames that it learns from."""

    network: text_or(name_in("screen_networks"), ScreenNetwork) = Field(
        description="a name, or a section"
    )
    training: text_or(name_in("screen_trainings"), ScreenTraining) = Field(
        description="a name, or a section"
    )
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")
    scenes: list[str] = Field(
        min_length=1, description="of the frame set's `scenes`: it learns from these alone"
    )
    lights: list[Annotated[int, Field(ge=0)]] | None = Field(
        None,
        min_length=1,
        description="numbers of the frame set's radii, from 0, that it learns; without it all",
    )
    seed: Seed | None = Field(None, description="of this training; without it the configuration's")
    label: Text | None = Field(None, description="its name in tables")
