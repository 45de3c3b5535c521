"""What must hold of `soft_scenes`."""

from neural_shadows.sections.frame_sets import measured_scenes
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check that each scene is of use, has no object twice, and that only a plate's can be raised."""
    used = {scene for frames in config.frame_sets.values() for scene in measured_scenes(frames)}
    for name, scene in config.soft_scenes.items():
        if name not in used:
            raise ValueError(
                f"soft_scenes.{name}: is in no frame set. Add it to `unseen` (or to `scenes`, for "
                "networks to train on) of one of `frame_sets`, or drop it: `null`"
            )
        if len(set(scene.inserted)) < len(scene.inserted):
            raise ValueError(
                f"soft_scenes.{name}.inserted = {scene.inserted}: must name each only once"
            )
        if scene.penumbra is not None and (scene.generate != "plate" or len(scene.inserted) != 1):
            raise ValueError(
                f"soft_scenes.{name}.penumbra: needs `generate: plate` and one object `inserted`"
            )
