"""Checks of `frame_sets`."""

from itertools import combinations
from typing import Any

from neural_shadows.sections.frame_sets import VIEWS, RenderedFrames, measured_scenes
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.views import Views
from neural_shadows.settings.base import check_among


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
        if frames.tuned_also_on:
            _check_tuned(config, name, frames)
        for first, second in combinations(measured_scenes(frames), 2):
            if _drawn_from(config, first) == _drawn_from(config, second):
                raise ValueError(
                    f"frame_sets.{name}: {first!r} and {second!r} are the same scene. "
                    "Change the `seed` of one"
                )


def _check_tuned(config: Sections, name: str, frames: RenderedFrames) -> None:
    """Check that frames for choosing constants have the same lights, and show no unseen scene."""
    key, other = f"frame_sets.{name}.tuned_also_on", frames.tuned_also_on
    rendered = [n for n, each in config.frame_sets.items() if isinstance(each, RenderedFrames)]
    check_among(key, other, [n for n in rendered if n != name])
    others = config.frame_sets[other]
    for setting in ("radii", "radius_unit", "light"):
        if getattr(frames, setting) != getattr(others, setting):
            raise ValueError(
                f"{key}: {other!r} has another `{setting}`. Choose a frame set under the same lights"
            )
    shown = [_drawn_from(config, scene) for scene in others.scenes]
    if seen := [scene for scene in frames.unseen if _drawn_from(config, scene) in shown]:
        raise ValueError(
            f"{key}: {other!r} shows {', '.join(seen)}, in `unseen` here. Choose another"
        )


def _drawn_from(config: Sections, scene: str) -> tuple[Any, ...]:
    """Generator, seeds, objects and penumbra of a scene."""
    settings = config.arrangement(scene)
    seed = config.layout_seed(scene)
    objects = set(settings.inserted)
    return settings.generate, seed, settings.new_layouts, objects, settings.penumbra
