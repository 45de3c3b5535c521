"""Texels round directions, for filters of looked-up texels alone."""

import numpy as np
from numba import njit

from neural_shadows.shadow_maps.light_map import LightMap, place_of, texel_of


def neighbourhood(
    light_map: LightMap, directions: np.ndarray, reach: int
) -> tuple[np.ndarray, np.ndarray]:
    """Find 2 (reach + 1) squared texels round directions, across cube edges.

    Returns:
        texels: (n, side, side) int64, rows downwards; −1 where the map has none.
        fractions: (n, 2) float64, right and down from the centre of the upper left one of the four
            innermost: the weights of a bilinear look-up.
    """
    side = 2 * (reach + 1)
    texels = np.empty((len(directions), side, side), np.int64)
    fractions = np.empty((len(directions), 2))
    maps = light_map.faces, light_map.half, light_map.resolution
    _fill(directions, *maps, reach, texels, fractions)
    return texels, fractions


@njit(cache=True, nogil=True)
def _fill(directions, faces, half, resolution, reach, texels, fractions):
    side = 2 * (reach + 1)
    for i in range(len(directions)):
        x, y, z = directions[i, 0], directions[i, 1], directions[i, 2]
        face, v, u = place_of(x, y, z, faces, half, resolution)
        if face < 0:
            texels[i], fractions[i] = -1, 0
            continue
        right, down, forward = faces[face, 0], faces[face, 1], faces[face, 2]
        column, row = int(np.floor(u - 0.5)), int(np.floor(v - 0.5))
        fractions[i, 0], fractions[i, 1] = u - 0.5 - column, v - 0.5 - row
        for a in range(side):
            for b in range(side):
                r, c = row + a - reach, column + b - reach
                if 0 <= r < resolution and 0 <= c < resolution:
                    texels[i, a, b] = (face * resolution + r) * resolution + c
                else:
                    p = ((c + 0.5) / resolution * 2 - 1) * half
                    q = ((r + 0.5) / resolution * 2 - 1) * half
                    texels[i, a, b] = texel_of(
                        forward[0] + p * right[0] + q * down[0],
                        forward[1] + p * right[1] + q * down[1],
                        forward[2] + p * right[2] + q * down[2],
                        faces,
                        half,
                        resolution,
                    )
