"""What must hold of `networks_by_scene`."""

from collections import Counter

from neural_shadows.config.checks.screen_experiments import check_method_name
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
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
