"""Voxels enclosed by a surface of voxels, by octree nodes."""

import numpy as np
from numba import njit

from neural_shadows.meshes.sides import root
from neural_shadows.representations.voxels.voxel_bricks import BRICK_LEVELS, MOST_LEVELS
from neural_shadows.representations.voxels.voxel_dag import (
    EMPTY,
    FULL,
    Octree,
    descend,
    node_offsets,
    octant,
    words_of,
)


def inside_of(surface: Octree) -> Octree:
    """Empty voxels enclosed by a surface, as an octree.

    As `enclosed_cells`, but by empty nodes of all sizes, side by side: for the Stanford dragon at
    2048³ voxels some 30 million instead of 8.6 billion.

    Args:
        surface: an octree, not a DAG.
    """
    words = words_of(surface)
    enclosed = _enclosed(words, len(surface.levels) + BRICK_LEVELS)
    *offsets, bricks = node_offsets(surface)
    above = []
    for level, offset in zip(surface.levels, offsets):
        inside = (enclosed[offset][:, None] >> np.arange(8) & 1).astype(bool)
        above.append(np.where(inside & (level == EMPTY), FULL, level))
    return Octree(above, enclosed[bricks[0] :].view(np.uint64) & ~surface.bricks)


@njit(cache=True, nogil=True)
def _enclosed(words, levels):
    """Mark enclosed empty children, or voxels of a brick.

    A bit of (w,) uint32 each. Empty node or voxel 32 w + c is child c of the node with its mask in
    word w.
    """
    outside = 32 * len(words)
    joined = np.arange(outside + 1).astype(np.int32)
    path = np.zeros(MOST_LEVELS, np.int64)
    # Stack of nodes: word, depth, and position in nodes of that depth.
    stack = np.empty((8 * MOST_LEVELS, 5), np.int64)
    stack[0] = 0
    height = 1
    while height:
        height -= 1
        node, depth, x, y, z = stack[height]
        brick = depth == levels - BRICK_LEVELS
        across = 4 if brick else 2
        followed = node
        for child in range(64 if brick else 8):
            cx = across * x + (child & 1) + (child >> 2 & 2)
            cy = across * y + (child >> 1 & 1) + (child >> 3 & 2)
            cz = across * z + (child >> 2 & 1) + (child >> 4 & 2)
            word = node + (child >> 5) if brick else node
            if words[word] >> np.uint32(child & 31) & np.uint32(1):
                if not brick:
                    followed += 1
                    stack[height, 0], stack[height, 1] = words[followed], depth + 1
                    stack[height, 2], stack[height, 3], stack[height, 4] = cx, cy, cz
                    height += 1
                continue
            own = 32 * node + child
            shift = 0 if brick else levels - depth - 1
            for side in range(6):
                # A voxel next to a corner of this node: of a neighbour as large or larger, or of
                # one of several smaller ones, which are united from their side.
                step = 1 << shift if side & 1 else -1
                nx = (cx << shift) + (step if side >> 1 == 0 else 0)
                ny = (cy << shift) + (step if side >> 1 == 1 else 0)
                nz = (cz << shift) + (step if side >> 1 == 2 else 0)
                if (nx | ny | nz) < 0 or (nx | ny | nz) >> levels:
                    _unite(joined, own, outside)
                    continue
                neighbour_depth, free = descend(words, path, 0, levels, nx, ny, nz)
                if free < 0:
                    continue
                at = path[neighbour_depth]
                if neighbour_depth == levels - BRICK_LEVELS:
                    other = 32 * at + octant(nx, ny, nz) + 8 * octant(nx >> 1, ny >> 1, nz >> 1)
                else:
                    other = 32 * at + octant(nx >> free, ny >> free, nz >> free)
                _unite(joined, own, other)
    enclosed = np.zeros(len(words), np.uint32)
    end = root(joined, outside)
    for number in range(outside):
        if root(joined, number) != end:
            enclosed[number >> 5] |= np.uint32(1) << np.uint32(number & 31)
    return enclosed


@njit(cache=True, nogil=True)
def _unite(joined, a, b):
    joined[root(joined, a)] = root(joined, b)
