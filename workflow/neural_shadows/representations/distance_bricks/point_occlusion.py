"""Occlusion of points under a directional light, by a solid's field."""

import numpy as np

from neural_shadows.representations.distance_bricks.field_bricks import FieldBricks
from neural_shadows.representations.distance_bricks.field_occlusion import occluded
from neural_shadows.representations.distance_bricks.sphere_entry import enter_sphere


def occluded_points(
    points: np.ndarray, to_light: np.ndarray, bricks: FieldBricks, steps: int
) -> np.ndarray:
    """Test points (n, 3) float32 in radii of the field's sphere, (n,) bool.

    Args:
        to_light: (3,) unit vector.
        steps: samples on a diameter, see `occluded`.
    """
    to_light, n = np.asarray(to_light, np.float32), len(points)
    index, origins = np.empty(n, np.int64), np.empty((n, 3), np.float32)
    s, chord = np.empty((2, n), np.float32)
    rays = enter_sphere(points, to_light, index, origins, s, chord)
    ends = np.minimum(s[:rays], chord[:rays])
    occlusion = np.zeros(n, bool)
    occlusion[index[:rays]] = occluded(origins[:rays], -to_light, ends, bricks, steps)
    return occlusion
