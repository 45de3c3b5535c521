"""Sparse voxel octrees with equal subtrees stored once.

After Kämpe, Sintorn and Assarsson, "High resolution sparse voxel DAGs" (2013), whose nodes these
are: a word of 32 bits with the mask of the children, and a word with the offset of each child. The
lowest two levels are a brick of 4³ voxels in 64 bits, as in Careil, Billeter and Eisemann,
"Interactively modifying compressed sparse voxel representations" (2020).
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from neural_shadows.representations.depths import LIT
from neural_shadows.representations.voxels.voxel_bricks import BRICK_LEVELS, MOST_LEVELS, Bricks

# Instead of a child: all its voxels are empty, or all occupied.
EMPTY, FULL = -1, -2

# Set bits of a child mask.
COUNTS = np.bitwise_count(np.arange(256, dtype=np.uint8)).astype(np.uint32)


class Octree(NamedTuple):
    """Nodes by level, from the root down; a DAG shares children."""

    levels: list[np.ndarray]  # each (n, 8) int64, by octant (x the lowest bit) a node of the next
    bricks: np.ndarray  # (n,) uint64, the nodes of the last: see `Bricks.masks`


def octree(bricks: Bricks, levels: int) -> Octree:
    """Build the octree of at least one brick.

    Args:
        levels: log2 of the voxels an axis.
    """
    codes, nodes = bricks.codes, np.arange(len(bricks.codes))
    above = []
    for _ in range(levels - BRICK_LEVELS):
        first = np.flatnonzero(np.diff(codes >> 3, prepend=-1))
        children = np.full((len(first), 8), EMPTY)
        parent = np.repeat(np.arange(len(first)), np.diff(first, append=len(codes)))
        children[parent, codes & 7] = nodes
        above.append(children)
        codes, nodes = codes[first] >> 3, np.arange(len(first))
    return Octree(above[::-1], bricks.masks)


def merged(tree: Octree) -> Octree:
    """Merge an octree's equal nodes, without empty ones: a DAG."""
    nonempty = tree.bricks != 0
    nodes = np.full(len(nonempty), EMPTY)
    bricks, nodes[nonempty] = np.unique(tree.bricks[nonempty], return_inverse=True)
    above = []
    for level in tree.levels[::-1]:
        children = np.where(level >= 0, nodes[level], level)
        nonempty = (children != EMPTY).any(1)
        nodes = np.full(len(level), EMPTY)
        children, nodes[nonempty] = np.unique(children[nonempty], axis=0, return_inverse=True)
        above.append(children)
    return Octree(above[::-1], bricks)


def node_offsets(tree: Octree) -> list[np.ndarray]:
    """Word offsets of each level's nodes, the bricks last."""
    sizes = [1 + (level != EMPTY).sum(1) for level in tree.levels]
    sizes.append(np.full(len(tree.bricks), 2))
    flat = np.concatenate(sizes)
    return np.split(np.cumsum(flat) - flat, np.cumsum([len(size) for size in sizes])[:-1])


def words_of(tree: Octree) -> np.ndarray:
    """Encode an octree or DAG: (w,) uint32, its root at 0.

    A full child has offset 0. A tree without any voxel is one word, 0.
    """
    words = [np.zeros(0, np.uint32)]
    for level, below in zip(tree.levels, node_offsets(tree)[1:]):
        node, child = np.nonzero(level != EMPTY)
        masks = ((level != EMPTY) << np.arange(8)).sum(1)
        target = level[node, child]
        offsets = np.where(target == FULL, 0, below[target] if len(below) else 0)
        # Each node's mask precedes the offsets of its children.
        first = np.searchsorted(node, np.arange(len(level)))
        words.append(np.insert(offsets, first, masks).astype(np.uint32))
    words.append(tree.bricks.view(np.uint32))
    return np.concatenate(words) if len(tree.levels[0]) else np.zeros(1, np.uint32)


def check_offsets(words: np.ndarray, levels: int) -> None:
    """Raise ValueError for nodes or offsets beyond the words."""
    nodes = np.zeros(1, np.int64)
    for _ in range(levels - BRICK_LEVELS):
        _check_within(nodes, words)
        masks = words[nodes]
        _check_within(nodes + COUNTS[masks & np.uint32(255)], words)
        children = []
        for child in range(8):
            held = masks >> np.uint32(child) & np.uint32(1) == 1
            before = COUNTS[masks[held] & np.uint32((1 << child) - 1)]
            children.append(words[nodes[held] + 1 + before])
        nodes = np.unique(np.concatenate(children)).astype(np.int64)
        nodes = nodes[nodes > 0]  # without full children
    _check_within(nodes + 1, words)


def _check_within(offsets: np.ndarray, words: np.ndarray) -> None:
    if (offsets >= len(words)).any():
        raise ValueError(f"a node beyond its {len(words)} words")


@njit(cache=True, nogil=True)
def first_voxels(origins, directions, words, levels):
    """Entry t (n,) float32 into the first voxel; `LIT` for misses.

    The largest empty node around a ray's position is left in one step; the descent to the next
    begins at their lowest common node.

    Args:
        origins, directions: (n, 3) float32, from the unit sphere inward.
        words: see `words_of`; levels: log2 of the voxels an axis.
    """
    t_hit = np.empty(len(origins), np.float32)
    scale = 0.5 * (1 << levels)
    last = (1 << levels) - 1
    path = np.zeros(MOST_LEVELS, np.int64)
    position, step, inverse = np.empty(3), np.empty(3), np.empty(3)
    cell, low = np.empty(3, np.int64), np.empty(3, np.int64)
    for ray in range(len(origins)):
        chord = 0.0
        for k in range(3):
            chord -= 2 * origins[ray, k] * directions[ray, k]
            position[k] = (origins[ray, k] + 1) * scale
            step[k] = directions[ray, k] * scale
            inverse[k] = 1 / step[k] if step[k] != 0 else 0.0
            cell[k] = min(max(int(np.floor(position[k])), 0), last)
        t_hit[ray] = LIT
        t, depth = 0.0, 0
        while t < chord:
            depth, free = descend(words, path, depth, levels, cell[0], cell[1], cell[2])
            if free < 0:
                t_hit[ray] = t
                break
            # Leave the empty node of 2^free voxels an axis.
            side = 1 << free
            t, axis = np.inf, 0
            for k in range(3):
                low[k] = cell[k] >> free << free
                if step[k] != 0:
                    leave = (low[k] + (side if step[k] > 0 else 0) - position[k]) * inverse[k]
                    if leave < t:
                        t, axis = leave, k
            changed = 0
            for k in range(3):
                if k == axis:
                    entered = low[k] + side if step[k] > 0 else low[k] - 1
                else:
                    entered = int(np.floor(position[k] + t * step[k]))
                    entered = min(max(entered, low[k]), low[k] + side - 1)
                changed |= cell[k] ^ entered
                cell[k] = entered
            if cell[axis] < 0 or cell[axis] > last:
                break
            while changed >> (levels - depth):
                depth -= 1
    return t_hit


@njit(cache=True, nogil=True, inline="always")
def descend(words, path, depth, levels, x, y, z):
    """Descend from node path[depth] to voxel x, y, z.

    Returns the last node's depth, and −1 if the voxel is occupied, else log2 of the side of the
    empty node around it. `path` gets the offset of each depth's node.
    """
    while True:
        shift = levels - 1 - depth
        node = path[depth]
        child = octant(x >> shift, y >> shift, z >> shift)
        if depth == levels - BRICK_LEVELS:
            voxels = words[node + (child >> 2)] >> np.uint32(8 * (child & 3))
            if voxels & np.uint32(255) == 0:
                return depth, 1
            return depth, -1 if voxels >> np.uint32(octant(x, y, z)) & np.uint32(1) else 0
        mask = words[node]
        if not mask >> np.uint32(child) & np.uint32(1):
            return depth, shift
        offset = words[node + 1 + COUNTS[mask & np.uint32((1 << child) - 1)]]
        if offset == 0:
            return depth, -1
        path[depth + 1] = offset
        depth += 1


@njit(cache=True, nogil=True, inline="always")
def octant(x, y, z):
    """Octant of a node in its parent."""
    return (x & 1) | (y & 1) << 1 | (z & 1) << 2
