"""`networks_by_scene`: methods with one network per scene."""

from pydantic import Field

from neural_shadows.sections.experiments import ScreenExperimentName
from neural_shadows.settings.base import Model, Text


class NetworksByScene(Model):
    """One method of several networks, each for its own scenes."""

    experiments: list[ScreenExperimentName] = Field(
        min_length=1,
        description="experiments on frames, trained on different scenes; other scenes are not evaluated",
    )
    label: Text = Field(description="label in tables")
