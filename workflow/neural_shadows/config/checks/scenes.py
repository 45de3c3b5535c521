"""Checks of `scenes`."""

from neural_shadows.sections.frame_sets import measured_scenes
from neural_shadows.sections.scenes import Arrangement, MeshScene, SingleAxisLight
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check lights and views of meshes; use and objects of arrangements."""
    used = {s for frames in config.soft_frame_sets.values() for s in measured_scenes(frames)}
    used |= {viewer.scene for viewer in config.viewers.values()}
    for name, scene in config.scenes.items():
        key = f"scenes.{name}"
        if isinstance(scene, MeshScene):
            _check_mesh(key, scene)
            continue
        if name not in used:
            raise ValueError(
                f"{key}: is in no frame set and no viewer. Add it to `unseen` (or `scenes`, for training) of "
                "one of `frame_sets` (a list replaces the whole: repeat its names), or remove it: `null`"
            )
        _check_arrangement(key, scene)


def _check_mesh(key: str, scene: MeshScene) -> None:
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


def _check_arrangement(key: str, scene: Arrangement) -> None:
    if len(set(scene.inserted)) < len(scene.inserted):
        raise ValueError(f"{key}.inserted = {scene.inserted}: must name each object once")
    if scene.penumbra is not None and (scene.generate != "plate" or len(scene.inserted) != 1):
        raise ValueError(f"{key}.penumbra: needs `generate: plate` and one object `inserted`")
