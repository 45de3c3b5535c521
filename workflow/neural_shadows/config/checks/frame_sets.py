"""What must hold of `frame_sets`."""

from itertools import combinations
from typing import Any

from neural_shadows.scenes.generators.registry import TRAINED, UNTRAINED
from neural_shadows.sections.frame_sets import measured_scenes
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check that what networks may train on is kept apart from what they never see."""
    for name, frames in config.frame_sets.items():
        if isinstance(frames, OwnFrames):
            continue
        trained = [config.soft_scenes[scene] for scene in frames.scenes]
        for scene, one in zip(frames.scenes, trained):
            if one.generate in UNTRAINED:
                raise ValueError(
                    f"frame_sets.{name}.scenes: {scene!r} is a {one.generate}, which no network "
                    f"may train on; put it among `unseen` (for training: {', '.join(TRAINED)})"
                )
        # Another seed moves what stands in a trained generator's scene by 15 cm: nothing new.
        generators = {one.generate for one in trained}
        objects = {inserted for one in trained for inserted in one.inserted}
        for scene in frames.unseen:
            one = config.soft_scenes[scene]
            if one.generate in generators and objects.issuperset(one.inserted):
                raise ValueError(
                    f"frame_sets.{name}.unseen: {scene!r} is a {one.generate}, which networks train "
                    "on here, and nothing in it is new to them; let another object stand in it "
                    "(`inserted`)"
                )
        for scene, twin in combinations(measured_scenes(frames), 2):
            if _drawn_from(config, scene) == _drawn_from(config, twin):
                raise ValueError(
                    f"frame_sets.{name}: {scene!r} and {twin!r} are one scene and would count twice; "
                    "give one of them another `seed`"
                )


def _drawn_from(config: Sections, scene: str) -> tuple[Any, ...]:
    """All that a scene depends on: of one generator another seed is another layout."""
    one = config.soft_scenes[scene]
    return one.generate, config.layout_seed(scene), set(one.inserted), one.penumbra
