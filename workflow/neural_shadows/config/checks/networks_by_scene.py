"""Checks of `networks_by_scene`."""

from collections import Counter

from neural_shadows.config.checks.screen_experiments import check_method_name
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check names, and for one network per scene."""
    for name, section in config.networks_by_scene.items():
        key = f"networks_by_scene.{name}"
        check_method_name(key, name)
        if name in config.screen_experiments:
            raise ValueError(
                f"{key}: an entry of `screen_experiments` has this name. Choose another"
            )
        scenes = Counter(
            scene
            for experiment in section.experiments
            for scene in config.screen_experiments[experiment].scenes
        )
        if twice := [scene for scene, count in scenes.items() if count > 1]:
            raise ValueError(
                f"{key}.experiments: {twice[0]!r} has two networks. Give each scene one network"
            )
