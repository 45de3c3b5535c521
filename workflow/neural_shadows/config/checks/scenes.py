"""Checks of `scenes`."""

from neural_shadows.sections.scenes import SingleAxisLight
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check lights and view sets of scenes."""
    for name, scene in config.scenes.items():
        key = f"scenes.{name}"
        if isinstance(scene.light, SingleAxisLight) and scene.light.axis == scene.up:
            raise ValueError(
                f"{key}.light.axis = {scene.light.axis!r}: must be horizontal, not `up`. "
                f"Allowed: {', '.join(sorted({'x', 'y', 'z'} - {scene.up}))}"
            )
        if len(set(scene.view_sets)) < len(scene.view_sets):
            raise ValueError(f"{key}.view_sets = {scene.view_sets}: must name each view set once")
        if not scene.ground and "shadow" in scene.view_sets:
            raise ValueError(
                f"{key}.view_sets: 'shadow' needs a scene with ground: true. "
                "Allowed here: 'surface', 'centre'"
            )
