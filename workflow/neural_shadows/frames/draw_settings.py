"""Random cameras and lights of frames with shadows [Hu et al. 2025, 4]."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.light_shape import SPHERE, LightShape
from neural_shadows.rendering.soft_shadows import OFFSET
from neural_shadows.rendering.surface import Surface, see_surface
from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.cameras import Camera, Window
from neural_shadows.scenes.scene import Scene
from neural_shadows.settings.records import LightMapSettings
from neural_shadows.shadow_maps.light_map import LightMap, cube_map, perspective_map

EYE_CLEARANCE, LIGHT_CLEARANCE = 0.02, 0.03  # of the scene's size
IN_MAP = 0.99  # of a frame's points, at least (Datta et al. 2022 have no others)
_DRAWS = 500
_PREVIEW = 64  # pixels along a frame's longer side


@dataclass(frozen=True)
class FrameKind:
    """Properties common to all frames of a set.

    Args:
        width, height: in pixels; fov: vertical, in degrees, of the whole frame.
        of: width and height of the whole frame where frames are windows of one; else None.
        radius: of the largest light, in metres, see `LightShape`. shape: of all lights.
    """

    width: int
    height: int
    fov: float
    of: Sequence[int] | None
    light_map: LightMapSettings
    radius: float
    shape: LightShape = SPHERE


def light_map_of(
    settings: LightMapSettings,
    scene: SoftScene,
    centre: np.ndarray,
    aimed_from: np.ndarray | None = None,
    shape: LightShape = SPHERE,
) -> LightMap:
    """Make the map of a light at a place.

    A perspective map looks at the middle of the cameras' targets, unless the light's shape fits it
    to the scene.

    Args:
        aimed_from: the point that it aims from, if not its centre.
    """
    if settings["kind"] == "cube":
        return cube_map(centre, settings["resolution"])
    if view := shape.map_view(scene.at_rest, centre):
        return perspective_map(centre, view.forward, view.fov, settings["resolution"], view.near)
    targets = scene.arrangement.targets
    forward = (targets.low + targets.high) / 2 - (centre if aimed_from is None else aimed_from)
    return perspective_map(centre, forward, settings["fov"], settings["resolution"])


def draw_setting(scene: SoftScene, kind: FrameKind, rng: np.random.Generator) -> Setting:
    """Draw a camera and a light, both clear of objects, with shadows.

    Raises:
        InputError: none of 500 draws can be used, with the reasons.
    """
    reasons: Counter[str] = Counter()
    opened = scene.at_rest
    for _ in range(_DRAWS):
        setting = _drawn(scene, kind, rng)
        fault = why_unusable(scene, opened, kind, setting)
        if fault is None:
            return setting
        reasons[fault] += 1
    raise none_usable(scene, f"{_DRAWS} draws of a camera and a light", reasons)


def none_usable(scene: SoftScene, draws: str, reasons: Counter[str]) -> InputError:
    """The error of a scene without usable draws, with counted reasons."""
    counts = ", ".join(f"{fault} ({count})" for fault, count in reasons.most_common())
    return InputError(
        f"{scene.arrangement.name}: none of {draws} can be used: {counts}. Change its regions "
        "or the frame set's light map."
    )


def _drawn(scene: SoftScene, kind: FrameKind, rng: np.random.Generator) -> Setting:
    arrangement = scene.arrangement
    eye, target = (region.draw(rng) for region in (arrangement.cameras, arrangement.targets))
    centre = kind.shape.draw_centre(arrangement.lights, scene.at_rest, rng)
    window = None
    if kind.of is not None:
        corner = [rng.integers(0, whole - part + 1) for whole, part in _sides(kind)]
        window = Window(*kind.of, *map(int, corner))
    return Setting(Camera(eye, target, UP, kind.fov, window), centre, np.eye(4))


def _sides(kind: FrameKind):
    return zip(kind.of, (kind.width, kind.height), strict=True)


def why_unusable(scene: SoftScene, opened: Scene, kind: FrameKind, setting: Setting) -> str | None:
    """The reason against a setting; None if it can be used.

    Args:
        opened: the scene with its mover as in the setting.
    """
    if not is_clear(opened, setting.camera.eye, EYE_CLEARANCE * opened.size):
        return "the camera is in an object or near one"
    clearance = LIGHT_CLEARANCE * opened.size + kind.shape.reach(kind.radius)
    if not is_clear(opened, setting.centre, clearance):
        return "the light is in an object or near one"
    surface = preview(opened, kind, setting)
    if len(surface.p) < 0.5 * surface.width * surface.height:
        return "the camera sees little"
    light_map = light_map_of(kind.light_map, scene, setting.centre, shape=kind.shape)
    if np.mean(light_map.texels_of(surface.p - setting.centre) >= 0) < IN_MAP:
        return "visible points lie outside the light's map"
    least, most = scene.arrangement.lit
    lit = lit_from(opened, surface, setting.centre)
    return None if least <= lit.mean() <= most else "nearly all pixels are lit, or all dark"


def lit_from(opened: Scene, surface: Surface, centre: np.ndarray) -> np.ndarray:
    """Which points of a surface see the light's centre, (n,) bool."""
    to_light = centre - surface.p
    start = surface.p + np.float32(OFFSET * opened.size) * surface.n_g
    lit = ~opened.tracer.blocked(start, to_light.astype(np.float32))
    return lit & (np.einsum("ij,ij->i", surface.n_g, to_light) > 0)


def preview(opened: Scene, kind: FrameKind, setting: Setting) -> Surface:
    """Trace a frame's surface at low resolution."""
    camera, scale = setting.camera, _PREVIEW / max(kind.width, kind.height)
    width, height = (max(1, round(side * scale)) for side in (kind.width, kind.height))
    if camera.window is not None:
        parts = (round(side * scale) for side in vars(camera.window).values())
        camera = replace(camera, window=Window(*parts))
    return see_surface(opened, camera, width, height)


def is_clear(scene: Scene, place: np.ndarray, distance: float) -> bool:
    """Test a place's clearance from objects by 64 rays; False also inside one."""
    k = np.arange(64) + 0.5
    height, angle = 1 - 2 * k / 64, np.pi * (1 + 5**0.5) * k
    across = np.sqrt(1 - height**2)
    directions = np.stack([across * np.cos(angle), height, across * np.sin(angle)], axis=1)
    directions = directions.astype(np.float32)
    t, face = scene.tracer.first_hit(np.tile(place.astype(np.float32), (64, 1)), directions)
    inner_side = np.einsum("ij,ij->i", scene.joined.face_normals[face], directions) > 0
    inside = np.mean(inner_side & (face >= 0)) > 0.5
    return bool(t.min() >= distance and not inside)
