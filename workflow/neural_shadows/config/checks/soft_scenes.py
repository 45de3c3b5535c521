"""Checks of `soft_scenes`."""

from neural_shadows.sections.frame_sets import measured_scenes
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check use, inserted objects and penumbra of soft scenes."""
    used = {scene for frames in config.frame_sets.values() for scene in measured_scenes(frames)}
    for name, scene in config.soft_scenes.items():
        if name not in used:
            raise ValueError(
                f"soft_scenes.{name}: is in no frame set. Add it to `unseen` (or `scenes`, for "
                "training) of one of `frame_sets`, or remove it: `null`"
            )
        if len(set(scene.inserted)) < len(scene.inserted):
            raise ValueError(
                f"soft_scenes.{name}.inserted = {scene.inserted}: must name each object once"
            )
        if scene.penumbra is not None and (scene.generate != "plate" or len(scene.inserted) != 1):
            raise ValueError(
                f"soft_scenes.{name}.penumbra: needs `generate: plate` and one object `inserted`"
            )
