"""A half-plane between a ground and a disc light: what the ground sees of it, in closed form."""

import numpy as np
import trimesh
from shapes import sheet

CENTRE = np.array([0.0, 4.0, 0.0])  # of the light


def half_plane(height: float) -> trimesh.Trimesh:
    """It covers x > 0."""
    shape = sheet(height, 20.0)
    shape.apply_translation([20, 0, 0])
    return shape


def share_seen(x: np.ndarray, height: float, radius: float) -> np.ndarray:
    """Of a disc that faces points at x on the ground (Datta et al. 2022, supplement)."""
    to_light = np.stack([CENTRE[0] - x, np.full_like(x, CENTRE[1])])
    edge = np.stack([-x, np.full_like(x, height)])
    across = np.stack([to_light[1], -to_light[0]]) / np.linalg.norm(to_light, axis=0)
    edge = edge * (to_light * to_light).sum(0) / (edge * to_light).sum(0)
    t = np.clip((edge * across).sum(0) / radius, -1, 1)
    return 1 - (np.arccos(t) - t * np.sqrt(1 - t * t)) / np.pi
