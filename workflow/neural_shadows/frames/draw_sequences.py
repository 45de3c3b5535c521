"""Settings of consecutive frames: camera, light, both or an object move a little from each to the next."""

from collections import Counter
from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from neural_shadows.frames.draw_settings import (
    FrameKind,
    draw_setting,
    none_usable,
    why_unusable,
)
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_scene import SoftScene

STEP = 0.004  # of the scene's size, from frame to frame: some pixels, and a texel or two
_TURN = 2.0  # degrees a frame that the object turns about the vertical
_KNOTS = 4
_DRAWS = 50


def draw_sequence(
    scene: SoftScene, kind: FrameKind, what: str, frames: int, rng: np.random.Generator
) -> list[Setting]:
    """Consecutive settings in which `camera`, `light`, `both` or the scene's mover (`object`) moves.

    Raises:
        InputError: of 50 paths none keeps clear of objects and in the light's map; says why.
    """
    why: Counter[str] = Counter()
    for _ in range(_DRAWS):
        settings = _along(scene, draw_setting(scene, kind, rng), what, frames, rng)
        wrong = [why_unusable(scene, scene.moved(one.motion), kind, one) for one in settings]
        if not any(wrong):
            return settings
        why.update({*filter(None, wrong)})
    raise none_usable(scene, f"{_DRAWS} paths ({what})", why)


def _along(
    scene: SoftScene, start: Setting, what: str, frames: int, rng: np.random.Generator
) -> list[Setting]:
    length = STEP * scene.at_rest.size * (frames - 1)
    still = np.zeros((frames, 3))
    eye = _path(length, frames, rng) if what in ("camera", "both") else still
    light = _path(length, frames, rng) if what in ("light", "both") else still
    settings = []
    for k in range(frames):
        camera = replace(start.camera, eye=start.camera.eye + eye[k])
        settings.append(replace(start, camera=camera, centre=start.centre + light[k]))
    if what == "object":
        motions = _motions(scene, _path(length, frames, rng) * (1, 0, 1))
        settings = [replace(one, motion=each) for one, each in zip(settings, motions)]
    return settings


def _path(length: float, frames: int, rng: np.random.Generator) -> np.ndarray:
    """A smooth way from 0 of about a length, (frames, 3): a spline through a few turns."""
    turns = rng.normal(size=(_KNOTS - 1, 3)) * (1, 0.3, 1)  # mostly level
    turns[1:] = turns[:-1] + 0.5 * turns[1:]
    turns *= length / (_KNOTS - 1) / np.linalg.norm(turns, axis=1, keepdims=True)
    knots = np.concatenate([np.zeros((1, 3)), turns.cumsum(0)])
    return CubicSpline(np.linspace(0, 1, _KNOTS), knots)(np.linspace(0, 1, frames))


def _motions(scene: SoftScene, way: np.ndarray) -> list[np.ndarray]:
    """Along a way (frames, 3) the mover turns about the vertical through its middle."""
    arrangement = scene.arrangement
    (vertices,) = [o.vertices for o in arrangement.objects if o.name == arrangement.mover]
    middle = (vertices.min(0) + vertices.max(0)) / 2
    motions = []
    for k, along in enumerate(way):
        motion = np.eye(4)
        motion[:3, :3] = Rotation.from_euler("y", _TURN * k, degrees=True).as_matrix()
        motion[:3, 3] = middle - motion[:3, :3] @ middle + along
        motions.append(motion)
    return motions
