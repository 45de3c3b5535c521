"""`screen_experiments`: screen-space networks, one training each."""

from typing import Annotated

from pydantic import Field

from neural_shadows.sections.networks import ScreenNetwork
from neural_shadows.sections.screen_trainings import ScreenTraining
from neural_shadows.settings.base import Model, Seed, Text, name_in, text_or


class ScreenExperiment(Model):
    """One screen-space network: architecture, training, frames, seed."""

    network: text_or(name_in("screen_networks"), ScreenNetwork) = Field(
        description="a name in `screen_networks`, or a section"
    )
    training: text_or(name_in("screen_trainings"), ScreenTraining) = Field(
        description="a name in `screen_trainings`, or a section"
    )
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")
    scenes: list[str] = Field(min_length=1, description="training scenes of the frame set")
    lights: list[Annotated[int, Field(ge=0)]] | None = Field(
        None,
        min_length=1,
        description="indices, from 0, of the frame set's radii for training; default: all",
    )
    seed: Seed | None = Field(None, description="seed of the training; default: the global seed")
    label: Text | None = Field(None, description="label in tables")
