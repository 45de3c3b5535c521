"""Whether points are in the shadow of a solid's field, for rays of one directional light.

A point is in shadow if the field is positive at any of its ray's samples before the point, those
that `first_crossings` looks at, or at the point itself. Which of them does not matter, and only
cells that the surface crosses have to be interpolated.
"""

import numpy as np
from numba import njit
from numba.cpython.unsafe.numbers import trailing_zeros

from neural_shadows.networks.object_space.field_bricks import FIRST, PAD, FieldBricks
from neural_shadows.networks.object_space.field_marching import BRICK, BRICK_VERTICES, trilinear
from neural_shadows.networks.object_space.light_tables import PARTS, TILES, light_tables

# Places on a ray are integers of 2^20 steps a cell: 1024 samples lose 0.0005 cells by rounding.
_CELL = 20
_BRICK = _CELL + 2  # bits in which a brick's BRICK cells are counted
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
    light = light_tables(bricks.grid, d, bricks.size / steps)
    _mark(origins, np.asarray(d, np.float64), ends, bricks, light, steps, found)
    return found


@njit(cache=True, nogil=True)
def _mark(origins, d, ends, bricks, light, steps, found):
    """Fill in `found`."""
    m, a, b = light.axes
    slope_a, slope_b = light.slopes
    low_u, low_v = light.low
    layers, enclosed, passed, slabs = light.layers, light.enclosed, light.cells, light.slabs
    shape, back, half = bricks.grid.shape, d[m] < 0, bricks.size / 2  # bricks a radius
    grid, masks, values = bricks.grid.ravel(), bricks.masks, bricks.values.ravel()
    told = grid, shape[1], shape[2], masks, values, bricks.level
    starts, beside_a, beside_b = _layer_starts(shape, light.axes, light.slopes, back)
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
        if end <= 0 or u < low_u or v < low_v or i >= layers.shape[0] or j >= layers.shape[1]:
            continue
        # The ray enters layer k at sample `begin` + k per_layer, counted in parts of one.
        begin = np.float32((front - place_m) * ahead - 0.5)
        last = np.float32(end * per_radius - 0.5)
        if begin + np.float32(enclosed[i, j] + 1) * per_layer < last:
            found[ray] = True
            continue
        samples = np.int64(np.ceil(last))
        x, y, z = _fixed(o[0] * half + mx), _fixed(o[1] * half + my), _fixed(o[2] * half + mz)
        in_a, in_b = _fixed(u), _fixed(v)
        met = near = False
        for word in range(layers.shape[2]):
            left = layers[i, j, word]
            near |= left != 0
            while left and not met:
                layer = np.int64(trailing_zeros(left)) + 64 * word
                left &= left - _ONE
                enter = begin + np.float32(layer) * per_layer
                if enter >= last:
                    break
                # The cells of four bricks that the ray may pass and that are not all outside.
                at_a, at_b = in_a + starts[layer, 0], in_b + starts[layer, 1]
                n = starts[layer, 2] + (at_a >> _BRICK) * beside_a + (at_b >> _BRICK) * beside_b
                part = (at_a >> _PART & PARTS - 1) * PARTS + (at_b >> _PART & PARTS - 1)
                cells = masks[grid[n], 0] & passed[part, 0]
                cells |= masks[grid[n + beside_b], 0] & passed[part, 1]
                cells |= masks[grid[n + beside_a], 0] & passed[part, 2]
                cells |= masks[grid[n + beside_a + beside_b], 0] & passed[part, 3]
                if cells == 0:
                    continue
                for slab in range(BRICK):
                    if cells & slabs[slab]:
                        first = np.int64(np.ceil(enter + np.float32(slab) * per_slab))
                        until = np.int64(np.ceil(enter + np.float32(slab + 1) * per_slab))
                        for k in range(max(first, 0), min(until, samples)):
                            # Sample k is k + 0.5 steps from the origin.
                            at = x + (dx >> 1) + k * dx, y + (dy >> 1) + k * dy
                            if _positive(at[0], at[1], z + (dz >> 1) + k * dz, told):
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
            met = inside and 0 <= z >> _BRICK < shape[2] and _positive(x, y, z, told)
        found[ray] = met


@njit(cache=True, nogil=True, inline="always")
def _fixed(bricks):
    """A length in 2^−20 cells."""
    return np.int64(np.floor(bricks * (1 << _BRICK) + 0.5))


@njit(cache=True, nogil=True)
def _layer_starts(shape, axes, slopes, back):
    """Of each layer: the least of slope_a m and of slope_b m in it, and its place in the flat grid.

    Also how far apart neighbours along a and b are there.
    """
    m, a, b = axes
    strides = shape[1] * shape[2], shape[2], 1
    starts = np.empty((shape[m], 3), np.int64)
    for layer in range(shape[m] - 2 * PAD):
        at = shape[m] - PAD - 1 - layer if back else layer + PAD
        for k in range(2):
            least = min(slopes[k] * at, slopes[k] * (at + 1))
            starts[layer, k] = np.int64(np.floor(least * (1 << _BRICK)))
        starts[layer, 2] = at * strides[m]
    return starts, strides[a], strides[b]


@njit(cache=True, nogil=True, inline="always")
def _positive(x, y, z, told):
    """Whether the field is positive at a place in the box, in 2^−20 cells."""
    grid, rows, columns, masks, values, level = told
    row = grid[((x >> _BRICK) * rows + (y >> _BRICK)) * columns + (z >> _BRICK)]
    i, j, k = x >> _CELL & BRICK - 1, y >> _CELL & BRICK - 1, z >> _CELL & BRICK - 1
    cell = np.uint64(BRICK**2 * i + BRICK * j + k)
    if masks[row, 0] >> cell & _ONE == 0:
        return False
    if masks[row, 1] >> cell & _ONE:
        return True
    at = (np.int64(row) - FIRST) * BRICK_VERTICES + (i * (BRICK + 1) + j) * (BRICK + 1) + k
    part, within = np.float32(1 / (1 << _CELL)), (1 << _CELL) - 1
    u, v, w = (x & within) * part, (y & within) * part, (z & within) * part
    return trilinear(values, at, np.float32(u), np.float32(v), np.float32(w)) > level
