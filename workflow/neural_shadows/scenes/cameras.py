"""Pinhole cameras, and view sets of the evaluation [4.1]."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

# See `draw_viewpoints`. The order determines the random streams.
VIEW_SETS = {
    "shadow": "aimed at the cast shadow",
    "surface": "aimed at the object's surface (self-shadowing)",
    "centre": "aimed at the object's centre",
}


@dataclass(frozen=True)
class Window:
    """Window of a larger frame, in that frame's pixels."""

    full_width: int
    full_height: int
    left: int
    top: int


@dataclass(frozen=True, eq=False)
class Camera:
    """Pinhole camera without roll, in scene units; vectors (3,) float64."""

    eye: np.ndarray
    target: np.ndarray
    up: np.ndarray
    fov: float  # vertical, degrees; of the whole frame
    window: Window | None = None  # None: images are whole frames

    def focal(self, height: int) -> float:
        """Focal length in pixels for an image height."""
        full_height = self.window.full_height if self.window else height
        return full_height / 2 / float(np.tan(np.radians(self.fov) / 2))


@dataclass(frozen=True, eq=False)
class Viewpoint:
    """Camera and light of a frame, normalised space; vectors (3,) float64."""

    view_set: str
    index: int
    eye: np.ndarray
    target: np.ndarray
    up: np.ndarray
    fov: float  # vertical, degrees
    light: np.ndarray  # unit vector towards the light
    window: ClassVar[None] = None  # images are whole frames


def camera_axes(eye: np.ndarray, target: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Orthonormal rows right, up, forward of a camera, (3, 3) float64."""
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(right, forward), forward])
