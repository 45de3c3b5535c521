"""Pinhole cameras."""

from dataclasses import dataclass

import numpy as np


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


def camera_axes(eye: np.ndarray, target: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Rows right, upward, forward of a camera: (3, 3) float64, orthonormal."""
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(right, forward), forward])
