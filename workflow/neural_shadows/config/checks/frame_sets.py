"""Checks of `frame_sets`."""

from itertools import combinations
from typing import Any

from neural_shadows.sections.frame_sets import VIEWS, RenderedFrames, measured_scenes
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.views import Views


def check(config: Sections) -> None:
    """Check `views`, and that training scenes and unseen scenes are disjoint."""
    if VIEWS not in config.frame_sets:
        raise ValueError(f"frame_sets.{VIEWS}: this key is missing")
    for name, frames in config.frame_sets.items():
        if isinstance(frames, Views) != (name == VIEWS):
            raise ValueError(
                f"frame_sets.{name}: only `{VIEWS}` holds views of meshes (`views_per_set`, …), "
                "and nothing else"
            )
        if not isinstance(frames, RenderedFrames):
            continue
        # Another seed moves objects of most generators by only 15 cm: such a scene is not unseen. Of
        # scenes with new layouts no other has theirs.
        trained = [config.arrangement(scene) for scene in frames.scenes]
        trained = [settings for settings in trained if not settings.new_layouts]
        generators = {settings.generate for settings in trained}
        objects = {inserted for settings in trained for inserted in settings.inserted}
        for scene in frames.unseen:
            settings = config.arrangement(scene)
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
    """Generator, seeds, objects and penumbra of a scene."""
    settings = config.arrangement(scene)
    seed = config.layout_seed(scene)
    objects = set(settings.inserted)
    return settings.generate, seed, settings.new_layouts, objects, settings.penumbra
