"""Voxels touched by a mesh's surface, as bricks of 4³."""

from typing import NamedTuple

import numpy as np
from numba import njit

from neural_shadows.representations.voxels.occupancy import SLACK, take_corners, touches

BRICK_LEVELS = 2  # a brick's 4³ voxels are two levels of an octree, and one word of 64 bits
MOST_LEVELS = 12  # 4096 voxels an axis


class Bricks(NamedTuple):
    """Bricks with voxels, in Morton order (three bits a level, x lowest)."""

    codes: np.ndarray  # (n,) int64, growing
    masks: np.ndarray  # (n,) uint64, bit m for the voxel of Morton code m in the brick


def surface_bricks(vertices: np.ndarray, faces: np.ndarray, levels: int) -> Bricks:
    """Bricks of voxels touched by a triangle, see `surface_cells`.

    Of 2^levels voxels an axis. Each triangle descends the octree from the root, so that time and
    memory grow with the touched bricks only.

    Args:
        vertices: (V, 3) positions in normalised space, inside [−1, 1]³.
        faces: (F, 3) vertex indices.
        levels: of the octree, 2 to 12.
    """
    codes, masks = _descend(np.asarray(vertices, np.float64), np.asarray(faces, np.int64), levels)
    order = np.argsort(codes, kind="stable")
    codes, masks = codes[order], masks[order]
    first = np.flatnonzero(np.diff(codes, prepend=-1))
    masks = np.bitwise_or.reduceat(masks, first)
    nonempty = masks != 0  # the slack of a brick is larger than that of its voxels
    return Bricks(codes[first][nonempty], masks[nonempty])


@njit(cache=True, nogil=True)
def _descend(vertices, faces, levels):
    """Codes and masks of touched bricks, for each triangle."""
    codes = np.empty(1 << 16, np.int64)
    masks = np.empty(1 << 16, np.uint64)
    count = 0
    # Stack of nodes: level, Morton code, and position in cells of that level.
    stack = np.empty((8 * MOST_LEVELS, 5), np.int64)
    centre, corners, low, high = np.empty(3), np.empty((3, 3)), np.empty(3), np.empty(3)
    for f in range(len(faces)):
        take_corners(vertices, faces[f], corners, low, high)
        stack[0] = 0
        height = 1
        while height:
            height -= 1
            level, code, x, y, z = stack[height]
            if level == levels - BRICK_LEVELS:
                if count == len(codes):
                    codes = np.concatenate((codes, np.empty_like(codes)))
                    masks = np.concatenate((masks, np.empty_like(masks)))
                codes[count], masks[count] = code, 0
                count += 1
            size = 2.0 / (1 << (level + 1))
            half = size / 2 * SLACK
            for child in range(8):
                cx = 2 * x + (child & 1)
                cy = 2 * y + (child >> 1 & 1)
                cz = 2 * z + (child >> 2)
                centre[0] = (cx + 0.5) * size - 1
                centre[1] = (cy + 0.5) * size - 1
                centre[2] = (cz + 0.5) * size - 1
                apart = False
                for k in range(3):
                    apart |= low[k] > centre[k] + half or high[k] < centre[k] - half
                if apart or not touches(corners, centre[0], centre[1], centre[2], half):
                    continue
                if level + 1 == levels:
                    bit = np.uint64(code * 8 + child & 63)
                    masks[count - 1] |= np.uint64(1) << bit
                else:
                    stack[height, 0] = level + 1
                    stack[height, 1] = code * 8 + child
                    stack[height, 2], stack[height, 3], stack[height, 4] = cx, cy, cz
                    height += 1
    return codes[:count], masks[:count]
