"""`networks_by_scene`: methods that ask of each scene's frames the network that learned the scene."""

from pydantic import Field

from neural_shadows.settings.base import Model, Text, name_in


class NetworksByScene(Model):
    """One method of several networks; it has no answer for a scene that none of them learned."""

    experiments: list[name_in("screen_experiments")] = Field(
        min_length=1, description="names in `screen_experiments`, each of other scenes"
    )
    label: Text = Field(description="its name in tables")
