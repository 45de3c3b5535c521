"""Checks of `frame_sets`."""

from itertools import combinations
from typing import Any

from neural_shadows.scenes.generators.registry import TRAINED, UNTRAINED
from neural_shadows.sections.frame_sets import measured_scenes
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check that training scenes and unseen scenes are disjoint."""
    for name, frames in config.frame_sets.items():
        if isinstance(frames, OwnFrames):
            continue
        trained = [config.soft_scenes[scene] for scene in frames.scenes]
        for scene, settings in zip(frames.scenes, trained):
            if settings.generate in UNTRAINED:
                raise ValueError(
                    f"frame_sets.{name}.scenes: {scene!r} has the generator {settings.generate!r}, which "
                    f"is for tests only. Move it to `unseen` (for training: {', '.join(TRAINED)})"
                )
        # Another seed moves objects of a training generator by only 15 cm: such a scene is not unseen.
        generators = {settings.generate for settings in trained}
        objects = {inserted for settings in trained for inserted in settings.inserted}
        for scene in frames.unseen:
            settings = config.soft_scenes[scene]
            if settings.generate in generators and objects.issuperset(settings.inserted):
                raise ValueError(
                    f"frame_sets.{name}.unseen: {scene!r} has the generator {settings.generate!r} and "
                    "no object beyond those of `scenes`. Insert another object (`inserted`)"
                )
        for first, second in combinations(measured_scenes(frames), 2):
            if _drawn_from(config, first) == _drawn_from(config, second):
                raise ValueError(
                    f"frame_sets.{name}: {first!r} and {second!r} are the same scene. "
                    "Change the `seed` of one"
                )


def _drawn_from(config: Sections, scene: str) -> tuple[Any, ...]:
    """Generator, seed, objects and penumbra of a scene."""
    settings = config.soft_scenes[scene]
    seed = config.layout_seed(scene)
    return settings.generate, seed, set(settings.inserted), settings.penumbra
