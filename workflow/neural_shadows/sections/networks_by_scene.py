"""`networks_by_scene`: methods with one network per scene."""

from pydantic import Field

from neural_shadows.settings.base import Model, Text, name_in


class NetworksByScene(Model):
    """One method of several networks, each for its own scenes."""

    experiments: list[name_in("screen_experiments")] = Field(
        min_length=1,
        description="names in `screen_experiments`, trained on different scenes; other scenes are not evaluated",
    )
    label: Text = Field(description="label in tables")
