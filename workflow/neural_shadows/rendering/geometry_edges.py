"""Where a pixel shows more than one surface: there an error is of antialiasing, not of shadows."""

from collections.abc import Sequence

import numpy as np

from neural_shadows.rendering.surface import Surface

_OFF_PLANE = 0.002  # of the distance to the eye
_TURNED = 0.4  # length of the difference of two unit normals: 23°


def geometry_edges(surfaces: Sequence[Surface]) -> np.ndarray:
    """Pixels whose places do not all see the first one's plane, (height, width) bool.

    Args:
        surfaces: what one camera sees at several places in each pixel, the first at its middle.
    """
    first, *others = surfaces
    eye = first.camera.eye.astype(np.float32)
    place, normal, seen = _images(first)
    limit = _OFF_PLANE * np.linalg.norm(place - eye, axis=2)
    edges = np.zeros((first.height, first.width), bool)
    for other in others:
        there, turned, also = _images(other)
        off = np.abs(np.einsum("ijk,ijk->ij", there - place, normal)) > limit
        edges |= (also != seen) | off | (np.linalg.norm(turned - normal, axis=2) > _TURNED)
    return edges


def _images(surface: Surface) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, normals, and where there are some."""
    seen = surface.image(np.ones(len(surface.pixel), bool), False)
    return surface.image(surface.p), surface.image(surface.n_g), seen
