"""How wide the penumbrae of a frame are by Neural Shadow Mapping's model (Datta et al. 2022, 3.6)."""

import numpy as np

from neural_shadows.frames.features import penumbra_model
from neural_shadows.rendering.blockers import blockers
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
) -> np.ndarray:
    """Widths in pixels at the points of a surface, (n,): seen head-on at their depths; 0 where all of
    the light is seen.

    Args:
        centre: (3,) of the light, radius: its, in the scene's unit. focal: of the camera, in pixels.
        chosen: indices of the points, if not all.
    """
    chosen = np.arange(len(surface.p)) if chosen is None else chosen
    p, camera = np.take(surface.p, chosen, axis=0), surface.camera
    nearest, farthest = blockers(scene, surface, chosen, centre, radius)
    widths = penumbra_model(np.linalg.norm(p - centre, axis=1), nearest, farthest, radius)
    forward = camera_axes(camera.eye, camera.target, camera.up)[2]
    return widths * focal / ((p - camera.eye) @ forward)
