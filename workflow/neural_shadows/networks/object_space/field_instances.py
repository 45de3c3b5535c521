"""Many copies of few solids' fields, each where it stands: whether anything blocks a way.

A copy is a transform and a box in a tree. A ray asks those copies whose boxes it meets, and no more
once one of them hides the light [3.6.2].
"""

from collections.abc import Sequence

import numpy as np
from numba import njit

from neural_shadows.networks.object_space.field_bricks import FieldBricks
from neural_shadows.networks.object_space.field_set import field_set, meets, to_box
from neural_shadows.scenes.instance_tree import MOST_WAITING, WIDTH, boxes_met, instance_tree, over
from neural_shadows.scenes.tracing import NEARLY_ALL


class FieldInstances:
    """Fields that stand in a scene.

    Args:
        fields: of solids, each in [−1, 1]³, with as many bits a corner.
        kinds: (n,) which of the fields each instance is of.
        placements: (n, 4, 4) from the field's space to the scene's, invertible and affine: turned,
            scaled, mirrored or moved.
    """

    def __init__(self, fields: Sequence[FieldBricks], kinds: np.ndarray, placements: np.ndarray):
        self._fields = field_set(fields)
        self._kinds = np.asarray(kinds, np.int32)
        self._to_boxes = np.stack([to_box(field) for field in fields])
        self.place(placements)

    def place(self, placements: np.ndarray) -> None:
        """Move the instances, as of a new frame; their fields stay what they are."""
        to_boxes = self._to_boxes[self._kinds]
        ways_out = placements @ np.linalg.inv(to_boxes)
        sizes = self._fields.shapes[self._kinds, 1:4]
        middles = np.einsum("nij,nj->ni", ways_out[:, :3, :3], sizes / 2) + ways_out[:, :3, 3]
        halves = np.einsum("nij,nj->ni", np.abs(ways_out[:, :3, :3]), sizes / 2)
        self._ways_in = np.linalg.inv(ways_out)[:, :3].astype(np.float32)
        self._tree = instance_tree(np.concatenate([middles - halves, middles + halves], axis=1))

    @property
    def bytes(self) -> int:
        """In memory, while it answers rays."""
        return self._fields.bytes + self.instance_bytes

    @property
    def instance_bytes(self) -> int:
        """Of these those of the instances, and not of the fields."""
        return self._ways_in.nbytes + self._kinds.nbytes + self._tree.bytes

    def occluded(self, points: np.ndarray, towards: np.ndarray, bias: float = 0.0) -> np.ndarray:
        """Whether anything lies in a direction from each point, (n,) bool.

        Args:
            points, towards: (n, 3) float32, directions to a light without a place.
            bias: how near to its point nothing counts, in lengths of its direction.
        """
        return self._asked(points, towards, bias, np.inf)

    def blocked(self, points: np.ndarray, ways: np.ndarray, bias: float = 0.0) -> np.ndarray:
        """Whether anything lies between each point and where its way leads, see `Tracer.blocked`.

        Args:
            points, ways: (n, 3) float32. bias: as of `occluded`, a share of each way.
        """
        return self._asked(points, ways, bias, NEARLY_ALL)

    def _asked(self, points, ways, begin: float, end: float) -> np.ndarray:
        found = np.zeros(len(points), bool)
        _ask(points, ways, begin, end, self._fields, self._kinds, self._ways_in, self._tree, found)
        return found


@njit(cache=True, nogil=True)
def _ask(points, ways, begin, end, fields, kinds, ways_in, tree, found):
    """Fill in `found`."""
    waiting, met = np.empty(MOST_WAITING, np.int32), np.empty(WIDTH, np.float32)
    place, way_over = np.empty(3, np.float32), np.empty(3, np.float32)
    first, last = np.float32(begin), np.float32(end)
    told = fields.shapes, fields.grid, fields.masks, fields.first, fields.words
    boxes, children = tree.boxes, tree.children
    for ray in range(len(points)):
        x, y, z = np.float64(points[ray, 0]), np.float64(points[ray, 1]), np.float64(points[ray, 2])
        u, v, w = np.float64(ways[ray, 0]), np.float64(ways[ray, 1]), np.float64(ways[ray, 2])
        place[0], place[1], place[2] = x, y, z
        way_over[0], way_over[1], way_over[2] = over(u), over(v), over(w)
        waiting[0], left, hidden = 0, 1, False
        while left and not hidden:
            left -= 1
            node = waiting[left]
            if node < 0:
                hidden = _meets_instance(
                    -1 - node, x, y, z, u, v, w, begin, end, told, kinds, ways_in
                )
                continue
            boxes_met(boxes, node, place, way_over, first, last, met)
            for child in range(WIDTH):
                if met[child] >= 0:
                    waiting[left] = children[node, child]
                    left += 1
        found[ray] = hidden


@njit(cache=True, nogil=True, inline="always")
def _meets_instance(one, x, y, z, u, v, w, begin, end, told, kinds, ways_in):
    """Whether a ray meets an instance's field between `begin` and `end`, in ways."""
    kind, shapes = kinds[one], told[0]
    a, p = _along(ways_in, one, 0, x, y, z, u, v, w)
    b, q = _along(ways_in, one, 1, x, y, z, u, v, w)
    c, r = _along(ways_in, one, 2, x, y, z, u, v, w)
    begin, end = _within(a, p, shapes[kind, 1], begin, end)
    begin, end = _within(b, q, shapes[kind, 2], begin, end)
    begin, end = _within(c, r, shapes[kind, 3], begin, end)
    return begin < end and meets(told, kind, a, b, c, p, q, r, begin, end)


@njit(cache=True, nogil=True, inline="always")
def _along(ways_in, one, axis, x, y, z, u, v, w):
    """Where a ray starts along an axis of an instance's box, and how far its way goes there."""
    a, b, c = ways_in[one, axis, 0], ways_in[one, axis, 1], ways_in[one, axis, 2]
    return a * x + b * y + c * z + ways_in[one, axis, 3], a * u + b * v + c * w


@njit(cache=True, nogil=True, inline="always")
def _within(place, way, size, begin, end):
    """The part of a ray that is between 0 and `size` along one axis."""
    way_over = over(way)
    s, t = -place * way_over, (size - place) * way_over
    return max(begin, min(s, t)), min(end, max(s, t))
