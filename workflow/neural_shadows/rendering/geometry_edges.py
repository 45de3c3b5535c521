"""Edges of the geometry, with errors of antialiasing instead of shadows."""

from collections.abc import Sequence

import numpy as np

from neural_shadows.rendering.surface import Surface

_OFF_PLANE = 0.002  # of the distance to the eye
_TURNED = 0.4  # length of the difference of two unit normals: 23°


def geometry_edges(surfaces: Sequence[Surface]) -> np.ndarray:
    """Find pixels with more than one plane, (height, width) bool.

    Args:
        surfaces: one camera's surfaces at several places in each pixel, the first at its middle.
    """
    first, *others = surfaces
    eye = first.camera.eye.astype(np.float32)
    place, normal, seen = _images(first)
    limit = _OFF_PLANE * np.linalg.norm(place - eye, axis=2)
    edges = np.zeros((first.height, first.width), bool)
    for other in others:
        other_place, other_normal, other_seen = _images(other)
        off = np.abs(np.einsum("ijk,ijk->ij", other_place - place, normal)) > limit
        turned = np.linalg.norm(other_normal - normal, axis=2) > _TURNED
        edges |= (other_seen != seen) | off | turned
    return edges


def _images(surface: Surface) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Images of positions, normals, and pixels with a surface."""
    seen = surface.image(np.ones(len(surface.pixel), bool), False)
    return surface.image(surface.p), surface.image(surface.n_g), seen
