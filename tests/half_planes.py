"""A half-plane between a ground and a disc light: what the ground sees of it, in closed form."""

import numpy as np
import trimesh
from shapes import scene_of, sheet

from neural_shadows.rendering.light_shape import SPHERE
from neural_shadows.rendering.soft_shadows import soft_visibility
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.scene import Scene

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


def joined(*shapes: trimesh.Trimesh) -> Scene:
    """A scene of several shapes as they lie, in metres."""
    return scene_of(trimesh.util.concatenate([*shapes]), ground=False, light=None)


def down(height: float, half: float) -> Camera:
    """A camera over the origin that sees a square of the ground, twice `half` along a side."""
    fov = np.degrees(2 * np.arctan(half / height))
    return Camera(np.array([0, height, 0.001]), np.zeros(3), np.array([0, 0, -1.0]), fov)


def visible(radii, shape=SPHERE, centre=CENTRE, height=1.0, half=0.3):
    """Visibility by radius, and x in ±half, of ground points past the edge of a half-plane."""
    # Under the half-plane, so that it sees the ground on both sides of the edge's shadow.
    view = joined(sheet(0.0, 30.0), half_plane(height)), down(0.4, half / 16), 256, 16
    light = {"centre": centre, "radii": radii, "shape": shape}
    images = soft_visibility(*view, **light, samples=64, adaptive=False)
    surface = see_surface(*view)
    return images, surface.image(surface.p)[..., 0].astype(float)
