"""Pinhole cameras, and the ways in which those of the evaluation frames are aimed [4.1]."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

# By view set; see `draw_viewpoints`. The order is part of the random stream of each.
VIEW_SETS = {
    "shadow": "aimed at the cast shadow",
    "surface": "aimed at the object's surface (self-shadowing)",
    "centre": "aimed at the object's centre",
}


@dataclass(frozen=True)
class Window:
    """Which part of a larger frame an image is, in that frame's pixels."""

    full_width: int
    full_height: int
    left: int
    top: int


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera without roll, in its scene's unit; vectors (3,) float64."""

    eye: np.ndarray
    target: np.ndarray
    up: np.ndarray
    fov: float  # vertical, degrees; of the whole frame
    window: Window | None = None  # None: its images are whole frames

    def focal(self, height: int) -> float:
        """The focal length in pixels of an image of that height."""
        whole = self.window.full_height if self.window else height
        return whole / 2 / float(np.tan(np.radians(self.fov) / 2))


@dataclass(frozen=True, eq=False)
class Viewpoint:
    """A pinhole camera and the light of its frame, in normalised space; vectors (3,) float64."""

    view_set: str
    index: int
    eye: np.ndarray
    target: np.ndarray
    up: np.ndarray
    fov: float  # vertical, degrees
    light: np.ndarray  # unit vector towards the light
    window: ClassVar[None] = None  # its images are whole frames


def camera_axes(eye: np.ndarray, target: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Rows right, upward, forward of a camera: (3, 3) float64, orthonormal."""
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(right, forward), forward])
