"""Visible share of a round distant light."""

from collections.abc import Callable

import numpy as np

from neural_shadows.representations.distance_bricks.field_cones import (
    ConeField,
    dim_by_field,
    split_disc,
)
from neural_shadows.representations.distance_bricks.field_marching import FAR
from neural_shadows.scenes.lights import light_basis

_GOLDEN = np.pi * (3 - 5**0.5)


def past_solid(
    field: ConeField,
    points: np.ndarray,
    direction: np.ndarray,
    slope: float,
    walks: int,
    push: float,
) -> np.ndarray:
    """Visible share past a solid's field, (n,) float32.

    Args:
        points: (n, 3) float32 in radii. direction: (3,), to the light.
        slope: tangent of the light's angular radius.
        walks, push: see `split_disc` and `dim_by_field`.
    """
    visible = np.ones(len(points), np.float32)
    normals = np.tile(np.float32(direction), (len(points), 1))
    whole = np.zeros(3, np.float32), np.float32(1), field
    arguments = split_disc(walks), np.float32(push)
    dim_by_field(
        points, normals, FAR * normals, FAR * np.float32(slope), *whole, *arguments, visible
    )
    return visible


def past_sheet(
    occluded: Callable[[np.ndarray, np.ndarray], np.ndarray],
    points: np.ndarray,
    direction: np.ndarray,
    slope: float,
    rays: int,
) -> np.ndarray:
    """Share of even rays to a disc that are not occluded, (n,) float32.

    Args:
        occluded: of points (n, 3) in a direction (3,).
        points, direction, slope: see `past_solid`.
    """
    k = np.arange(rays) + 0.5
    radii, angles = slope * np.sqrt(k / rays), _GOLDEN * k
    right, across, _ = light_basis(direction)
    disc = radii[:, None] * (np.cos(angles)[:, None] * right + np.sin(angles)[:, None] * across)
    directions = direction + disc
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    lit = np.zeros(len(points), np.float32)
    for towards in directions:
        lit += ~occluded(points, towards)
    return lit / np.float32(rays)
