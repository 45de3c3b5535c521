"""Perturbed frames: light and camera moved a little, for temporal losses."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from neural_shadows.frames.draw_settings import FrameKind, light_map_of, preview
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.settings.records import Perturbation


def twin_of(
    scene: SoftScene,
    kind: FrameKind,
    setting: Setting,
    amplitudes: Perturbation,
    rng: np.random.Generator,
) -> Setting:
    """Perturb a setting.

    Args:
        amplitudes: either `light` and `eye`, how far each coordinate moves at most, in shares of the
            scene's size, and `turn_deg`, how far the view turns about each axis (Hu et al. 2025);
            or those of `reach` (Datta et al. 2022, 3.3), and the view does not turn.
    """
    camera, view = setting.camera, setting.camera.target - setting.camera.eye
    if "light_texels" in amplitudes:
        light, eye = (radius * _in_ball(rng) for radius in reach(scene, kind, setting, amplitudes))
    else:
        size = scene.at_rest.size
        light_unit = kind.shape.motion_unit(size)
        eye = size * amplitudes["eye"] * rng.uniform(-1, 1, 3)
        turn = Rotation.from_rotvec(amplitudes["turn_deg"] * rng.uniform(-1, 1, 3), degrees=True)
        view = turn.apply(view)
        light = light_unit * amplitudes["light"] * rng.uniform(-1, 1, 3)
    eye = camera.eye + eye
    moved = replace(camera, eye=eye, target=eye + view)
    return replace(setting, camera=moved, centre=setting.centre + light)


def reach(
    scene: SoftScene, kind: FrameKind, setting: Setting, amplitudes: Perturbation
) -> tuple[float, float]:
    """Largest motions of a perturbed frame's light and eye, in metres.

    They change a point's texel but not its pixel: perturbed frames are compared pixel by pixel.

    Args:
        amplitudes: `light_texels` at the frame's median distance from the light, and `light_radii`
            of the largest light beside them; `eye_pixels` at its median distance from the eye.
    """
    surface = preview(scene.moved(setting.motion), kind, setting)
    from_light, from_eye = (
        float(np.median(np.linalg.norm(surface.p - place, axis=1)))
        for place in (setting.centre, setting.camera.eye)
    )
    light_map = light_map_of(kind.light_map, scene, setting.centre, shape=kind.shape)
    texel = 2 * light_map.half / light_map.resolution
    # A shadow's edge moves by so many texels: a sun, by as much more as it is farther away.
    light = amplitudes["light_texels"] * kind.shape.motion_unit(1.0) * from_light * texel
    light += amplitudes["light_radii"] * kind.radius
    return light, amplitudes["eye_pixels"] * from_eye / setting.camera.focal(kind.height)


def _in_ball(rng: np.random.Generator) -> np.ndarray:
    """A uniform point in the unit ball, (3,) float64."""
    direction = rng.normal(size=3)
    return direction / np.linalg.norm(direction) * rng.uniform() ** (1 / 3)
