"""`networks_by_scene`: methods that ask of each scene's frames the network that learned the scene."""

from collections import Counter
from typing import TYPE_CHECKING

from pydantic import Field

from neural_shadows.config.base import Model, Text, name_in
from neural_shadows.config.screen_experiments import check_method_name

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class NetworksByScene(Model):
    """One method of several networks; it has no answer for a scene that none of them learned."""

    experiments: list[name_in("screen_experiments")] = Field(
        min_length=1, description="names in `screen_experiments`, each of other scenes"
    )
    label: Text = Field(description="its name in tables")


def check(config: "Config") -> None:
    """Check that no scene has two networks, and that no other method has the name."""
    for name, section in config.networks_by_scene.items():
        key = f"networks_by_scene.{name}"
        check_method_name(key, name)
        if name in config.screen_experiments:
            raise ValueError(
                f"{key}: an entry of `screen_experiments` has this name; choose another"
            )
        learned = Counter(
            scene for one in section.experiments for scene in config.screen_experiments[one].scenes
        )
        if twice := [scene for scene, count in learned.items() if count > 1]:
            raise ValueError(
                f"{key}.experiments: {twice[0]!r} is learned by two of them; give each scene one network"
            )
