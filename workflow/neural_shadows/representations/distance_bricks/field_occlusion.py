"""Shadow of a solid's field under one directional light.

A point is in shadow if the field is positive at any of its ray's samples before the point, those
that `first_crossings` looks at, or at the point itself. Which of them does not matter, and only
cells that the surface crosses have to be interpolated.
"""

import numpy as np
from numba import njit
from numba.cpython.unsafe.numbers import trailing_zeros

from neural_shadows.representations.distance_bricks.cell_words import CELL, positive_in_brick
from neural_shadows.representations.distance_bricks.field_bricks import NODE, PAD, FieldBricks
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.representations.distance_bricks.light_tables import (
    NEVER,
    PARTS,
    TILES,
    light_tables,
)

_BRICK = CELL + 2  # bits in which a brick's BRICK cells are counted
_NODE = _BRICK + 2  # and a node's NODE bricks
_PART = _BRICK - 4  # and the PARTS of a brick's side
_ONE = np.uint64(1)


def occluded(
    origins: np.ndarray, d: np.ndarray, ends: np.ndarray, bricks: FieldBricks, steps: int
) -> np.ndarray:
    """Whether the field is met on the way from each origin to its end, (k,) bool.

    Args:
        origins: (k, 3) float32, on the unit sphere.
        d: (3,) float32 unit vector, pointing inward.
        ends: (k,) float32, no farther than the sphere's other side; at 0 or before nothing is met.
        steps: samples on a diameter; sample i lies at t = 2 (i + 0.5) / steps.
    """
    found = np.zeros(len(origins), bool)
    light = light_tables(bricks, d, bricks.size / steps)
    _mark(origins, np.asarray(d, np.float64), ends, bricks, light, steps, found)
    return found


@njit(cache=True, nogil=True)
def _mark(origins, d, ends, bricks, light, steps, found):
    """Fill in `found`."""
    m, a, b = light.axes
    slope_a, slope_b = light.slopes
    low_u, low_v = light.low
    offsets, ends_of, layers, enclosed = light.offsets, light.ends, light.layers, light.enclosed
    passed, slabs = light.cells, light.slabs
    shape, back, half = bricks.shape, d[m] < 0, bricks.size / 2  # bricks a radius
    nodes, rows, masks = bricks.nodes.ravel(), bricks.rows, bricks.masks
    field = nodes, bricks.nodes.shape, rows, masks, bricks.first, bricks.words
    places_m, places_a, places_b = (
        _places_along(bricks, m),
        _places_along(bricks, a),
        _places_along(bricks, b),
    )
    starts = _layer_starts(shape[m], places_m, light.slopes, back)
    # Samples in a radius, in a layer, and in a quarter of one, a cell.
    per_radius = steps / 2
    per_layer = np.float32(steps / (bricks.size * abs(d[m])))
    per_slab = per_layer / np.float32(BRICK)
    front = shape[m] - PAD if back else PAD
    ahead = -per_layer if back else per_layer
    # The middle of the whole cube from the box's corner, in bricks; the way between two samples.
    mx, my, mz = half - bricks.corner[0], half - bricks.corner[1], half - bricks.corner[2]
    mm, ma, mb = half - bricks.corner[m], half - bricks.corner[a], half - bricks.corner[b]
    sx, sy, sz = d[0] * half / per_radius, d[1] * half / per_radius, d[2] * half / per_radius
    dx, dy, dz = _fixed(sx), _fixed(sy), _fixed(sz)
    for ray in range(len(origins)):
        o, end = origins[ray], np.float64(ends[ray])
        place_m = o[m] * half + mm
        u = o[a] * half + ma - slope_a * place_m
        v = o[b] * half + mb - slope_b * place_m
        i, j = np.int64((u - low_u) * TILES), np.int64((v - low_v) * TILES)
        if end <= 0 or u < low_u or v < low_v or i >= len(offsets):
            continue
        tile = offsets[i] + j
        if tile < ends_of[i] or tile >= ends_of[i + 1]:
            continue
        # The ray enters layer k at sample `begin` + k per_layer, counted in parts of one.
        begin = np.float32((front - place_m) * ahead - 0.5)
        last = np.float32(end * per_radius - 0.5)
        sure = enclosed[tile]
        if sure != NEVER and begin + np.float32(sure + 1) * per_layer < last:
            found[ray] = True
            continue
        samples = np.int64(np.ceil(last))
        x, y, z = _fixed(o[0] * half + mx), _fixed(o[1] * half + my), _fixed(o[2] * half + mz)
        in_a, in_b = _fixed(u), _fixed(v)
        met = near = False
        for word in range(layers.shape[1]):
            left = layers[tile, word]
            near |= left != 0
            while left and not met:
                layer = np.int64(trailing_zeros(left)) + 64 * word
                left &= left - _ONE
                enter = begin + np.float32(layer) * per_layer
                if enter >= last:
                    break
                # The cells of four bricks that the ray may pass and that are not all outside.
                at_a, at_b = in_a + starts[layer, 0], in_b + starts[layer, 1]
                in_m, k_a, k_b = starts[layer, 2], at_a >> _BRICK, at_b >> _BRICK
                part = (at_a >> _PART & PARTS - 1) * PARTS + (at_b >> _PART & PARTS - 1)
                low_a, high_a = in_m + places_a[k_a], in_m + places_a[k_a + 1]
                low_b, high_b = places_b[k_b], places_b[k_b + 1]
                cells = masks[_row(low_a + low_b, nodes, rows), 0] & passed[part, 0]
                cells |= masks[_row(low_a + high_b, nodes, rows), 0] & passed[part, 1]
                cells |= masks[_row(high_a + low_b, nodes, rows), 0] & passed[part, 2]
                cells |= masks[_row(high_a + high_b, nodes, rows), 0] & passed[part, 3]
                if cells == 0:
                    continue
                for slab in range(BRICK):
                    if cells & slabs[slab]:
                        first = np.int64(np.ceil(enter + np.float32(slab) * per_slab))
                        until = np.int64(np.ceil(enter + np.float32(slab + 1) * per_slab))
                        for k in range(max(first, 0), min(until, samples)):
                            # Sample k is k + 0.5 steps from the origin.
                            at = x + (dx >> 1) + k * dx, y + (dy >> 1) + k * dy
                            if _positive(at[0], at[1], z + (dz >> 1) + k * dz, field):
                                met = True
                                break
                        if met:
                            break
        if near and not met:
            along = end * per_radius
            x += np.int64(along * dx)
            y += np.int64(along * dy)
            z += np.int64(along * dz)
            inside = 0 <= x >> _BRICK < shape[0] and 0 <= y >> _BRICK < shape[1]
            met = inside and 0 <= z >> _BRICK < shape[2] and _positive(x, y, z, field)
        found[ray] = met


@njit(cache=True, nogil=True, inline="always")
def _fixed(bricks):
    """A length in 2^−20 cells."""
    return np.int64(np.floor(bricks * (1 << _BRICK) + 0.5))


@njit(cache=True, nogil=True)
def _places_along(bricks, axis):
    """What a brick's coordinate along an axis adds to its place: its node's, in 64, and within it."""
    _, columns, depth = bricks.nodes.shape
    stride = (columns * depth, depth, 1)[axis] * NODE**3
    step = (NODE**2, NODE, 1)[axis]
    places = np.empty(bricks.nodes.shape[axis] * NODE, np.int64)
    for k in range(len(places)):
        places[k] = k // NODE * stride + k % NODE * step
    return places


@njit(cache=True, nogil=True, inline="always")
def _row(place, nodes, rows):
    """Of the brick at a place, the sum of `_places_along` of its coordinates."""
    return rows[nodes[place >> 6] + (place & 63)]


@njit(cache=True, nogil=True)
def _layer_starts(count, places, slopes, back):
    """Of each layer: the least of slope_a m and of slope_b m in it, and what m adds to a place."""
    starts = np.empty((count, 3), np.int64)
    for layer in range(count - 2 * PAD):
        at = count - PAD - 1 - layer if back else layer + PAD
        for k in range(2):
            least = min(slopes[k] * at, slopes[k] * (at + 1))
            starts[layer, k] = np.int64(np.floor(least * (1 << _BRICK)))
        starts[layer, 2] = places[at]
    return starts


@njit(cache=True, nogil=True, inline="always")
def _positive(x, y, z, field):
    """Whether the field is positive at a place in the box, in 2^−20 cells."""
    nodes, shape, rows, masks, first, words = field
    node = ((x >> _NODE) * shape[1] + (y >> _NODE)) * shape[2] + (z >> _NODE)
    within = (x >> _BRICK & 3) << 4 | (y >> _BRICK & 3) << 2 | z >> _BRICK & 3
    row = rows[nodes[node] + within]
    return positive_in_brick(masks[row, 0], masks[row, 1], first[row], words, x, y, z)
