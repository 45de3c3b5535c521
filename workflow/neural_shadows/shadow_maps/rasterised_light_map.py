"""A whole map of a light at a place by a z-buffer, which is how a renderer makes one."""

import numpy as np

from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.z_buffer import drawn

# Of the light's nearest and farthest: what is nearer along a face's axis is cut off.
_NEAR = 1e-4


def rasterised_depths(light_map: LightMap, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Distances in all texels, (texels,) float32, as `LightMap.depths` traces them but for rounding.

    Args:
        vertices: (V, 3) float32, faces: (F, 3) int32, of all objects. Both sides of a triangle count.
    """
    size, half = light_map.resolution, light_map.half
    offset = vertices.astype(np.float64) - light_map.centre
    found = np.empty((len(light_map.faces), size, size), np.float32)
    across = half * (2 * (np.arange(size) + 0.5) / size - 1)
    length = np.sqrt(1 + across[None, :] ** 2 + across[:, None] ** 2)  # of a ray that is 1 deep
    for image, axes in zip(found, light_map.faces):
        points, some = _before(offset @ axes.T, faces, _NEAR * np.abs(offset).max(initial=1.0))
        x, y, depth = points.T
        scale = size / (2 * half)
        x, y = (one / depth * scale + size / 2 - 0.5 for one in (x, y))
        # 1 / depth is linear in the picture.
        nearest = drawn(x, y, 1 / depth, some, size)
        image[:] = np.where(nearest > 0, length / np.maximum(nearest, 1e-30), np.inf)
    return found.ravel()


def _before(points: np.ndarray, faces: np.ndarray, near: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (V', 3) and faces (F', 3) of what lies deeper than `near`; cut there."""
    deep = points[:, 2] > near
    count = deep[faces].sum(1)
    whole, parts = faces[count == 3], []
    added = [points]
    first = len(points)
    for corners, kept in ((1, _one_deep), (2, _two_deep)):
        cut = _turned(faces[count == corners], deep, corners)
        new, some = kept(points, cut, near, first)
        added.append(new)
        parts.append(some)
        first += len(new)
    # What no face names is not divided by.
    together = np.concatenate(added)
    together[:, 2] = np.maximum(together[:, 2], near)
    return together, np.concatenate([whole, *parts])


def _turned(faces: np.ndarray, deep: np.ndarray, corners: int) -> np.ndarray:
    """The faces with the corner that differs from the two others first."""
    odd = deep[faces] if corners == 1 else ~deep[faces]
    order = (np.argmax(odd, axis=1)[:, None] + np.arange(3)) % 3
    return np.take_along_axis(faces, order, axis=1)


def _crossing(points: np.ndarray, a: np.ndarray, b: np.ndarray, near: float) -> np.ndarray:
    """Where edges from a (n,) to b (n,) are `near` deep."""
    p, q = points[a], points[b]
    share = (near - p[:, 2]) / (q[:, 2] - p[:, 2])
    return p + share[:, None] * (q - p)


def _one_deep(points, cut, near, first):
    """The first corner is deep: a smaller triangle is left."""
    new = np.concatenate([_crossing(points, cut[:, 0], cut[:, k], near) for k in (1, 2)])
    index = first + np.arange(len(cut))
    return new, np.stack([cut[:, 0], index, index + len(cut)], axis=1)


def _two_deep(points, cut, near, first):
    """The first corner is cut off: two triangles are left."""
    new = np.concatenate([_crossing(points, cut[:, 0], cut[:, k], near) for k in (1, 2)])
    index = first + np.arange(len(cut))
    one = np.stack([index, cut[:, 1], cut[:, 2]], axis=1)
    other = np.stack([index, cut[:, 2], index + len(cut)], axis=1)
    return new, np.concatenate([one, other])
