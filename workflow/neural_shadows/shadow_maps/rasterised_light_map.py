"""Rasterisation of a whole map of a light at a place."""

import numpy as np
from numba import njit

from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.z_buffer import drawn

# Near plane, in shares of the farthest vertex's offset.
_NEAR = 1e-4


def rasterised_depths(light_map: LightMap, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Rasterise distances in all texels, (texels,) float32.

    The same as `LightMap.depths` but for rounding.

    Args:
        vertices: (V, 3) float32, faces: (F, 3) int32, of all objects. Both sides of a triangle count.
    """
    size, half = light_map.resolution, light_map.half
    offset = vertices.astype(np.float64) - light_map.centre
    depths = np.empty((len(light_map.faces), size, size), np.float32)
    across = np.float32(half * (2 * (np.arange(size) + 0.5) / size - 1))
    for image, axes in zip(depths, light_map.faces):
        points, clipped = _before(offset @ axes.T, faces, _NEAR * np.abs(offset).max(initial=1.0))
        x, y, depth = points.T
        scale = size / (2 * half)
        x, y = (axis / depth * scale + size / 2 - 0.5 for axis in (x, y))
        # 1 / depth is linear in the picture.
        _fill_distances(drawn(x, y, 1 / depth, clipped, size), across, image)
    return depths.ravel()


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_distances(nearest, across, image):
    """Distances of texels (size, size) by the largest inverse depth; ∞ where it is 0."""
    none, far = np.float32(0), np.float32(np.inf)
    for row in range(len(across)):
        aslant = np.float32(1) + across[row] * across[row]
        for column in range(len(across)):
            inverse = nearest[row, column]
            length = np.sqrt(aslant + across[column] * across[column])  # of a ray that is 1 deep
            distance = length / inverse
            image[row, column] = distance if inverse > none else far


def _before(points: np.ndarray, faces: np.ndarray, near: float) -> tuple[np.ndarray, np.ndarray]:
    """Clip to depths above `near`: points (V', 3) and faces (F', 3)."""
    deep = points[:, 2] > near
    count = deep[faces].sum(1)
    whole, parts = faces[count == 3], []
    added = [points]
    first = len(points)
    for corners, clip in ((1, _one_deep), (2, _two_deep)):
        cut = _turned(faces[count == corners], deep, corners)
        new, triangles = clip(points, cut, near, first)
        added.append(new)
        parts.append(triangles)
        first += len(new)
    # Avoids division by the depth of unused points.
    together = np.concatenate(added)
    together[:, 2] = np.maximum(together[:, 2], near)
    return together, np.concatenate([whole, *parts], dtype=np.int32)


def _turned(faces: np.ndarray, deep: np.ndarray, corners: int) -> np.ndarray:
    """Rotate faces to begin with the corner unlike the others."""
    odd = deep[faces] if corners == 1 else ~deep[faces]
    order = (np.argmax(odd, axis=1)[:, None] + np.arange(3)) % 3
    return np.take_along_axis(faces, order, axis=1)


def _crossing(points: np.ndarray, a: np.ndarray, b: np.ndarray, near: float) -> np.ndarray:
    """Intersect edges from a (n,) to b (n,) with the near plane."""
    p, q = points[a], points[b]
    share = (near - p[:, 2]) / (q[:, 2] - p[:, 2])
    return p + share[:, None] * (q - p)


def _one_deep(points, cut, near, first):
    """Clip faces with the first corner deep: one triangle."""
    new = np.concatenate([_crossing(points, cut[:, 0], cut[:, k], near) for k in (1, 2)])
    index = first + np.arange(len(cut))
    return new, np.stack([cut[:, 0], index, index + len(cut)], axis=1)


def _two_deep(points, cut, near, first):
    """Clip faces with the first corner near: two triangles."""
    new = np.concatenate([_crossing(points, cut[:, 0], cut[:, k], near) for k in (1, 2)])
    index = first + np.arange(len(cut))
    first_half = np.stack([index, cut[:, 1], cut[:, 2]], axis=1)
    second_half = np.stack([index, cut[:, 2], index + len(cut)], axis=1)
    return new, np.concatenate([first_half, second_half])
