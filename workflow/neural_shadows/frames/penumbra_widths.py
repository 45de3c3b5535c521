"""Penumbra widths by Neural Shadow Mapping's model (Datta et al. 2022, 3.6)."""

import numpy as np

from neural_shadows.rendering.blockers import blockers
from neural_shadows.rendering.light_shape import SPHERE, LightShape
from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.cameras import camera_axes
from neural_shadows.scenes.scene import Scene


def model_widths(
    scene: Scene,
    surface: Surface,
    centre: np.ndarray,
    radius: float,
    focal: float,
    chosen: np.ndarray | None = None,
    shape: LightShape = SPHERE,
) -> np.ndarray:
    """Widths in pixels at a surface's points, (n,), seen head-on.

    0 where the whole light is visible.

    Args:
        centre: (3,) of the light, radius, shape: its, in the scene's unit. focal: of the camera, in pixels.
        chosen: indices of the points, if not all.
    """
    chosen = np.arange(len(surface.p)) if chosen is None else chosen
    p, camera = np.take(surface.p, chosen, axis=0), surface.camera
    nearest, farthest = blockers(scene, surface, chosen, centre, radius, shape)
    widths = penumbra_model(np.linalg.norm(p - centre, axis=1), nearest, farthest, radius)
    forward = camera_axes(camera.eye, camera.target, camera.up)[2]
    return widths * focal / ((p - camera.eye) @ forward)


def penumbra_model(
    z: np.ndarray, nearest: np.ndarray, farthest: np.ndarray, radius: float
) -> np.ndarray:
    """Width of the penumbra of a sphere between blockers (Datta et al., 3.6).

    From the outer boundary to the umbra's, in the unit of the distances; 0 where nothing blocks.

    Args:
        z: from the light to the receiver; nearest, farthest: to the blockers, NaN for none.
    """
    middle, half = (farthest + nearest) / 2, (farthest - nearest) / 2
    spread = np.arcsin(np.clip(half / np.hypot(middle, radius), 0, 1))
    angle = np.arctan(radius / middle)
    outer = z * np.tan(np.minimum(angle + spread, np.pi / 2 - 1e-3)) - radius
    inner = z * np.tan(angle - spread) - radius
    return np.nan_to_num(outer + inner, nan=0.0)
