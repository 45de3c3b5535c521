"""Settings of consecutive frames with small motions between them."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from neural_shadows.frames.draw_settings import (
    FrameKind,
    draw_setting,
    lit_from,
    none_usable,
    preview,
    why_unusable,
)
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_scene import SoftScene

STEP = 0.004  # of the scene's size, from frame to frame: some pixels, and a texel or two
LEAST_CHANGE = (
    0.0025  # of a picture and frame, lit before an object moved and dark after it, or contrariwise
)
_TURN = 2.0  # degrees a frame that the object turns about the vertical
_KNOTS = 4
_DRAWS = 200  # of which one in 6 to 17 shows what moves, in windows of large frames


def draw_sequence(
    scene: SoftScene, kind: FrameKind, what: str, frames: int, rng: np.random.Generator
) -> list[Setting]:
    """Draw consecutive settings with a moving camera, light or object, whose shadow is seen to move.

    Args:
        what: moves: `camera`, `light`, `both`, or `object`, the scene's mover.

    Raises:
        InputError: none of 200 paths keeps clear of objects and in the light's map, with the reasons.
    """
    reasons: Counter[str] = Counter()
    for _ in range(_DRAWS):
        settings = _along(scene, kind, draw_setting(scene, kind, rng), what, frames, rng)
        # First, since it moves the object once, and the others in each frame.
        faults = {why_still(scene, kind, settings) if what == "object" else None}
        if faults == {None}:
            faults = {
                why_unusable(scene, scene.moved(setting.motion), kind, setting)
                for setting in settings
            }
        if faults == {None}:
            return settings
        reasons.update(faults - {None})
    raise none_usable(scene, f"{_DRAWS} paths ({what})", reasons)


def why_still(scene: SoftScene, kind: FrameKind, settings: Sequence[Setting]) -> str | None:
    """The reason against an object's sequence: of the windows of a large frame few show it or its shadow."""
    lit = []
    for setting in (settings[0], settings[-1]):
        opened = scene.moved(setting.motion)
        surface = preview(opened, kind, setting)
        lit.append(surface.image(lit_from(opened, surface, setting.centre), False))
    changed = np.mean(lit[0] != lit[1]) / (len(settings) - 1)
    return None if changed >= LEAST_CHANGE else "no shadow of what moves is seen"


def _along(
    scene: SoftScene,
    kind: FrameKind,
    start: Setting,
    what: str,
    frames: int,
    rng: np.random.Generator,
) -> list[Setting]:
    size = scene.at_rest.size
    length, light_length = (
        STEP * unit * (frames - 1) for unit in (size, kind.shape.motion_unit(size))
    )
    still = np.zeros((frames, 3))
    eye = _path(length, frames, rng) if what in ("camera", "both") else still
    light = _path(light_length, frames, rng) if what in ("light", "both") else still
    settings = []
    for k in range(frames):
        camera = replace(start.camera, eye=start.camera.eye + eye[k])
        settings.append(replace(start, camera=camera, centre=start.centre + light[k]))
    if what == "object":
        motions = _motions(scene, _path(length, frames, rng) * (1, 0, 1))
        settings = [replace(setting, motion=motion) for setting, motion in zip(settings, motions)]
    return settings


def _path(length: float, frames: int, rng: np.random.Generator) -> np.ndarray:
    """A smooth path from 0 of about a length, (frames, 3): a spline."""
    turns = rng.normal(size=(_KNOTS - 1, 3)) * (1, 0.3, 1)  # mostly level
    turns[1:] = turns[:-1] + 0.5 * turns[1:]
    turns *= length / (_KNOTS - 1) / np.linalg.norm(turns, axis=1, keepdims=True)
    knots = np.concatenate([np.zeros((1, 3)), turns.cumsum(0)])
    return CubicSpline(np.linspace(0, 1, _KNOTS), knots)(np.linspace(0, 1, frames))


def _motions(scene: SoftScene, path: np.ndarray) -> list[np.ndarray]:
    """Turn the mover about its vertical axis along a path (frames, 3)."""
    vertices = scene.at_rest.objects[scene.arrangement.mover_index].vertices
    middle = (vertices.min(0) + vertices.max(0)) / 2
    motions = []
    for k, offset in enumerate(path):
        motion = np.eye(4)
        motion[:3, :3] = Rotation.from_euler("y", _TURN * k, degrees=True).as_matrix()
        motion[:3, 3] = middle - motion[:3, :3] @ middle + offset
        motions.append(motion)
    return motions
