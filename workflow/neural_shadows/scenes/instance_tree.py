"""Boxes of a scene's instances in a tree, in which a ray looks at those that it meets."""

from typing import NamedTuple

import numpy as np
from numba import njit

WIDTH = (
    8  # children of a node, whose boxes are looked at together; with 2 it took three times as long
)
MOST_WAITING = 8 * 16  # on a way down: a node and seven beside it on each of so many levels


class InstanceTree(NamedTuple):
    """Each node has the boxes of its children, and which these are."""

    boxes: np.ndarray  # (nodes, 6, WIDTH) float32, lowest and highest corners; none hold nothing
    children: np.ndarray  # (nodes, WIDTH) int32: a node, or −1 − the number of an instance

    @property
    def bytes(self) -> int:
        """In memory."""
        return self.boxes.nbytes + self.children.nbytes


def instance_tree(boxes: np.ndarray) -> InstanceTree:
    """The tree over boxes (n, 6) float32, n ≥ 1: halves along their longest side, thrice a node."""
    boxes = np.ascontiguousarray(boxes, np.float32)
    found = np.empty((len(boxes), 6, WIDTH), np.float32), np.empty((len(boxes), WIDTH), np.int32)
    found[0][:, :3], found[0][:, 3:], found[1][:] = np.inf, -np.inf, -1
    count = _build(boxes, *found)
    return InstanceTree(*(part[:count].copy() for part in found))


@njit(cache=True, nogil=True)
def _build(boxes, node_boxes, children):
    """Fill in the nodes, the root first, and return how many."""
    order, middles = np.arange(len(boxes)), boxes[:, :3] + boxes[:, 3:]
    ends = np.empty(WIDTH + 1, np.int64)  # of each child's part of `order`
    made = 1
    waiting = [(0, 0, len(boxes))]  # a node, and its part of `order`
    while waiting:
        node, ends[0], ends[1] = waiting.pop()
        # All nodes below are full but the last: else the lowest would have two or three children.
        least = 1
        while least * WIDTH < ends[1] - ends[0]:
            least *= WIDTH
        parts = 1
        while parts < WIDTH:
            for part in range(parts, 0, -1):
                low, high = ends[part - 1], ends[part]
                ends[2 * part] = ends[2 * part - 1] = high
                if high - low > least:
                    _sort(order[low:high], middles)
                    ends[2 * part - 1] = low + ((high - low) // 2 + least - 1) // least * least
            parts *= 2
        for child in range(WIDTH):
            low, high = ends[child], ends[child + 1]
            if low == high:
                continue
            for k in range(3):
                node_boxes[node, k, child] = boxes[order[low:high], k].min()
                node_boxes[node, k + 3, child] = boxes[order[low:high], k + 3].max()
            if high - low == 1:
                children[node, child] = -1 - order[low]
            else:
                children[node, child] = made
                waiting.append((made, low, high))
                made += 1
    return made


@njit(cache=True, nogil=True)
def _sort(order, middles):
    """Some boxes' numbers by their middles along the side where these differ most."""
    axis, widest = 0, np.float32(-1)
    for k in range(3):
        along = middles[order, k]
        if along.max() - along.min() > widest:
            axis, widest = k, along.max() - along.min()
    order[:] = order[np.argsort(middles[order, axis])]


@njit(cache=True, nogil=True, inline="always")
def over(way):
    """1 over a way along an axis; of none, so much that no box beside it is met."""
    return 1 / way if abs(way) > 1e-30 else 1e30


@njit(cache=True, nogil=True, fastmath={"nnan", "nsz"})
def boxes_met(boxes, node, place, way_over, begin, end, met):
    """How far a ray goes through each of a node's boxes, below 0 beside it: fills `met` (WIDTH,).

    Args:
        boxes: of the tree. place, way_over: (3,) float32, where it starts and `over` its way.
        begin, end: float32, the part of the ray, in ways.
    """
    x, y, z = place[0], place[1], place[2]
    u, v, w = way_over[0], way_over[1], way_over[2]
    i, j, k = 0 if u > 0 else 3, 1 if v > 0 else 4, 2 if w > 0 else 5
    near_x, near_y, near_z = boxes[node, i], boxes[node, j], boxes[node, k]
    far_x, far_y, far_z = boxes[node, 3 - i], boxes[node, 5 - j], boxes[node, 7 - k]
    for child in range(len(met)):  # not WIDTH: a known number is unrolled, and not made a vector
        first = max((near_x[child] - x) * u, (near_y[child] - y) * v)
        first = max(first, max((near_z[child] - z) * w, begin))
        last = min((far_x[child] - x) * u, (far_y[child] - y) * v)
        last = min(last, min((far_z[child] - z) * w, end))
        met[child] = last - first
