"""Voxels touched by a mesh's surface, as bricks of 4³."""

from typing import NamedTuple

import numpy as np
from numba import njit

from neural_shadows.representations.voxels.occupancy import SLACK, touches

BRICK_LEVELS = 2  # a brick's 4³ voxels are two levels of an octree, and one word of 64 bits
MOST_LEVELS = 12  # 4096 voxels an axis


class Bricks(NamedTuple):
    """The bricks that hold any voxel, in Morton order (three bits a level, x the lowest)."""

    codes: np.ndarray  # (n,) int64, growing
    masks: np.ndarray  # (n,) uint64, bit m for the voxel of Morton code m in the brick


def surface_bricks(vertices: np.ndarray, faces: np.ndarray, levels: int) -> Bricks:
    """Bricks of the 2^levels voxels an axis that a triangle touches, see `surface_cells`.

    Each triangle goes down the octree from the smallest node around it, so that time and memory
    are those of what it touches, however large it is.

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
    held = masks != 0  # the slack of a brick is larger than that of its voxels
    return Bricks(codes[first][held], masks[held])


@njit(cache=True, nogil=True)
def _descend(vertices, faces, levels):
    """A code and a mask for each triangle and brick that it touches."""
    codes = np.empty(1 << 16, np.int64)
    masks = np.empty(1 << 16, np.uint64)
    count = 0
    # Nodes that are left: level, Morton code, and place in cells of that level.
    todo = np.empty((8 * MOST_LEVELS, 5), np.int64)
    centre = np.empty(3)
    for f in range(len(faces)):
        corners = vertices[faces[f]]
        low = np.array([corners[:, k].min() for k in range(3)])
        high = np.array([corners[:, k].max() for k in range(3)])
        todo[0] = 0
        left = 1
        while left:
            left -= 1
            level, code, x, y, z = todo[left]
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
                if apart or not touches(corners - centre, half):
                    continue
                if level + 1 == levels:
                    bit = np.uint64(code * 8 + child & 63)
                    masks[count - 1] |= np.uint64(1) << bit
                else:
                    todo[left, 0] = level + 1
                    todo[left, 1] = code * 8 + child
                    todo[left, 2], todo[left, 3], todo[left, 4] = cx, cy, cz
                    left += 1
    return codes[:count], masks[:count]
