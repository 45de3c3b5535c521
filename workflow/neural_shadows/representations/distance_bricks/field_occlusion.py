"""Shadow of a solid's field under a directional light.

A point is in shadow if the field is positive at any of its ray's samples before the point, those of
`first_crossings`, or at the point itself. Their order does not matter, and only crossed cells have
to be interpolated.
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

_BRICK = CELL + 2  # bits of a coordinate within a brick of BRICK cells
_NODE = _BRICK + 2  # within a node of NODE bricks
_PART = _BRICK - 4  # within one of PARTS of a brick's side
_ONE = np.uint64(1)


def occluded(
    origins: np.ndarray, d: np.ndarray, ends: np.ndarray, bricks: FieldBricks, steps: int
) -> np.ndarray:
    """Test rays from origins to ends for occlusion, (k,) bool.

    Args:
        origins: (k, 3) float32, on the unit sphere.
        d: (3,) float32 unit vector, pointing inward.
        ends: (k,) float32, at most the chord; not occluded at 0 or below.
        steps: samples on a diameter; sample i lies at t = 2 (i + 0.5) / steps.
    """
    occlusion = np.zeros(len(origins), bool)
    light = light_tables(bricks, d, bricks.size / steps)
    _mark_occlusion(origins, np.asarray(d, np.float64), ends, bricks, light, steps, occlusion)
    return occlusion


@njit(cache=True, nogil=True)
def _mark_occlusion(origins, d, ends, bricks, light, steps, occlusion):
    """Fill in `occlusion`."""
    m, a, b = light.axes
    slope_a, slope_b = light.slopes
    low_u, low_v = light.low
    offsets, ends_of, layers, enclosed = light.offsets, light.ends, light.layers, light.enclosed
    passed, slabs = light.cells, light.slabs
    shape, back, half = bricks.shape, d[m] < 0, bricks.size / 2  # bricks a radius
    nodes, rows, masks = bricks.nodes.ravel(), bricks.rows, bricks.masks
    field = nodes, bricks.nodes.shape, rows, masks, bricks.first, bricks.words
    index_m, index_a, index_b = (
        _index_terms(bricks, m),
        _index_terms(bricks, a),
        _index_terms(bricks, b),
    )
    starts = _layer_starts(shape[m], index_m, light.slopes, back)
    # Samples in a radius, in a layer, and in a quarter of one, a cell.
    per_radius = steps / 2
    per_layer = np.float32(steps / (bricks.size * abs(d[m])))
    per_slab = per_layer / np.float32(BRICK)
    front = shape[m] - PAD if back else PAD
    ahead = -per_layer if back else per_layer
    # The cube's middle from the box's corner, in bricks; the step between samples.
    mx, my, mz = half - bricks.corner[0], half - bricks.corner[1], half - bricks.corner[2]
    mm, ma, mb = half - bricks.corner[m], half - bricks.corner[a], half - bricks.corner[b]
    sx, sy, sz = d[0] * half / per_radius, d[1] * half / per_radius, d[2] * half / per_radius
    dx, dy, dz = _fixed(sx), _fixed(sy), _fixed(sz)
    for ray in range(len(origins)):
        o, end = origins[ray], np.float64(ends[ray])
        m_start = o[m] * half + mm
        u = o[a] * half + ma - slope_a * m_start
        v = o[b] * half + mb - slope_b * m_start
        i, j = np.int64((u - low_u) * TILES), np.int64((v - low_v) * TILES)
        if end <= 0 or u < low_u or v < low_v or i >= len(offsets):
            continue
        tile = offsets[i] + j
        if tile < ends_of[i] or tile >= ends_of[i + 1]:
            continue
        # The ray enters layer k at sample `begin` + k per_layer, counted in parts of one.
        begin = np.float32((front - m_start) * ahead - 0.5)
        last = np.float32(end * per_radius - 0.5)
        sure = enclosed[tile]
        if sure != NEVER and begin + np.float32(sure + 1) * per_layer < last:
            occlusion[ray] = True
            continue
        samples = np.int64(np.ceil(last))
        x, y, z = _fixed(o[0] * half + mx), _fixed(o[1] * half + my), _fixed(o[2] * half + mz)
        in_a, in_b = _fixed(u), _fixed(v)
        hit = near = False
        for word in range(layers.shape[1]):
            left = layers[tile, word]
            near |= left != 0
            while left and not hit:
                layer = np.int64(trailing_zeros(left)) + 64 * word
                left &= left - _ONE
                enter = begin + np.float32(layer) * per_layer
                if enter >= last:
                    break
                # Cells of four bricks possibly passed by the ray and not all outside.
                at_a, at_b = in_a + starts[layer, 0], in_b + starts[layer, 1]
                in_m, k_a, k_b = starts[layer, 2], at_a >> _BRICK, at_b >> _BRICK
                part = (at_a >> _PART & PARTS - 1) * PARTS + (at_b >> _PART & PARTS - 1)
                low_a, high_a = in_m + index_a[k_a], in_m + index_a[k_a + 1]
                low_b, high_b = index_b[k_b], index_b[k_b + 1]
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
                                hit = True
                                break
                        if hit:
                            break
        if near and not hit:
            along = end * per_radius
            x += np.int64(along * dx)
            y += np.int64(along * dy)
            z += np.int64(along * dz)
            inside = 0 <= x >> _BRICK < shape[0] and 0 <= y >> _BRICK < shape[1]
            hit = inside and 0 <= z >> _BRICK < shape[2] and _positive(x, y, z, field)
        occlusion[ray] = hit


@njit(cache=True, nogil=True, inline="always")
def _fixed(bricks):
    """Convert a length to 2^−20 cells."""
    return np.int64(np.floor(bricks * (1 << _BRICK) + 0.5))


@njit(cache=True, nogil=True)
def _index_terms(bricks, axis):
    """Index terms of coordinates along an axis: the node's, times 64, plus the brick's."""
    _, columns, depth = bricks.nodes.shape
    stride = (columns * depth, depth, 1)[axis] * NODE**3
    step = (NODE**2, NODE, 1)[axis]
    indices = np.empty(bricks.nodes.shape[axis] * NODE, np.int64)
    for k in range(len(indices)):
        indices[k] = k // NODE * stride + k % NODE * step
    return indices


@njit(cache=True, nogil=True, inline="always")
def _row(index, nodes, rows):
    """Row of the brick at a sum of `_index_terms`."""
    return rows[nodes[index >> 6] + (index & 63)]


@njit(cache=True, nogil=True)
def _layer_starts(count, indices, slopes, back):
    """By layer: minima of slope_a m and slope_b m, and m's index."""
    starts = np.empty((count, 3), np.int64)
    for layer in range(count - 2 * PAD):
        at = count - PAD - 1 - layer if back else layer + PAD
        for k in range(2):
            least = min(slopes[k] * at, slopes[k] * (at + 1))
            starts[layer, k] = np.int64(np.floor(least * (1 << _BRICK)))
        starts[layer, 2] = indices[at]
    return starts


@njit(cache=True, nogil=True, inline="always")
def _positive(x, y, z, field):
    """Test the field's sign in the box, at 2^−20 cells."""
    nodes, shape, rows, masks, first, words = field
    node = ((x >> _NODE) * shape[1] + (y >> _NODE)) * shape[2] + (z >> _NODE)
    within = (x >> _BRICK & 3) << 4 | (y >> _BRICK & 3) << 2 | z >> _BRICK & 3
    row = rows[nodes[node] + within]
    return positive_in_brick(masks[row, 0], masks[row, 1], first[row], words, x, y, z)
