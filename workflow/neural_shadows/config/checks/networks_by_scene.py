"""Checks of `networks_by_scene`."""

from collections import Counter

from neural_shadows.config.checks.experiments import check_name_on_frames
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check names, and for one network per scene."""
    for name, section in config.networks_by_scene.items():
        key = f"networks_by_scene.{name}"
        check_name_on_frames(key, name)
        if name in config.experiments:
            raise ValueError(f"{key}: an entry of `experiments` has this name. Choose another")
        scenes = Counter(
            scene
            for experiment in section.experiments
            for scene in config.experiments[experiment].scenes
        )
        if twice := [scene for scene, count in scenes.items() if count > 1]:
            raise ValueError(
                f"{key}.experiments: {twice[0]!r} has two networks. Give each scene one network"
            )
