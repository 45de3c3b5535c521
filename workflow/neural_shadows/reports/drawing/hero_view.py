"""The default view of a scene."""

import numpy as np

from neural_shadows.scenes.cameras import Viewpoint
from neural_shadows.scenes.lights import light_basis

FOV = 36.0
DISTANCE = 3.6  # radii: the unit sphere then fills nine tenths of the frame


def hero_view(up: np.ndarray, distance: float = DISTANCE) -> Viewpoint:
    """A three-quarter view from above, lit from the left rear."""
    # From 20 degrees above the horizon and 30 off a coordinate axis, which shows most objects
    # from neither front nor side.
    side, across, _ = light_basis(up)
    heading = np.cos(np.radians(30)) * side + np.sin(np.radians(30)) * across
    eye = distance * (np.cos(np.radians(20)) * heading + np.sin(np.radians(20)) * up)
    # Most visible points are lit, and the shadow is visible too.
    light = heading + 0.9 * np.cross(heading, up) + 1.1 * up
    return Viewpoint("hero", 0, eye, np.zeros(3), up, FOV, light / np.linalg.norm(light))
