"""Occlusion of points by a field under one light.

A ray is sampled in two planes through each slab of `LightTables`, or four (`FieldBricks.density`), so
at least once a cell, between light and point, and at the point itself. A solid occludes a point if
any sample is inside it; a sheet, if two samples in succession lie on different sides of it and one
of them in a cell that it crosses. All samples lie at multiples of 2^−20 cells, so that
`field_occlusion.c`, the same in C, has the same answers to the bit.
"""

import numpy as np
from numba import njit
from numba.cpython.unsafe.numbers import trailing_zeros

from neural_shadows.representations.distance_bricks.cell_words import CELL, cell_state
from neural_shadows.representations.distance_bricks.compiled_occlusion import compiled_occlusion
from neural_shadows.representations.distance_bricks.field_bricks import (
    BRICK_BITS,
    NODE_BITS,
    FieldBricks,
)
from neural_shadows.representations.distance_bricks.field_marching import BRICK, INSIDE, OUTSIDE
from neural_shadows.representations.distance_bricks.light_tables import (
    DARK,
    DOUBLED,
    FIRST,
    LightTables,
    directional_tables,
    merging,
    point_tables,
)

_ONE = np.uint64(1)
_HALF = np.float32(0.5)
_LAMP = 4  # a point light's tables cost as much as so many directional lights'
_DIFFER = OUTSIDE + INSIDE  # two states, of both sides


def occluded(
    points: np.ndarray, to_light: np.ndarray, bricks: FieldBricks, depth_bias: float = 0.0
) -> np.ndarray:
    """Test points for occlusion from a directional light, (n,) bool.

    Args:
        points: (n, 3) float32, in the space of the field's cube [−1, 1]³, anywhere; one with a NaN
            or an infinity is not occluded.
        to_light: (3,) unit vector.
        depth_bias: how far the points are moved towards the light.
    """
    occlusion = np.zeros(len(points), bool)
    light = directional_tables(bricks, to_light, merging(len(points), bricks))
    blocks = depth_bias * bricks.size * (BRICK >> light.merged) / 2
    _mark(points, light, bricks, blocks * float(np.abs(to_light).max()), occlusion)
    return occlusion


def occluded_from(points: np.ndarray, position: np.ndarray, bricks: FieldBricks) -> np.ndarray:
    """Test points for occlusion from a point light, (n,) bool; see `occluded`.

    Args:
        position: (3,), in the space of the points, anywhere.
    """
    occlusion = np.zeros(len(points), bool)
    merged = merging(len(points) // _LAMP, bricks)
    for light in point_tables(bricks, position, merged):
        _mark(points, light, bricks, 0.0, occlusion)
    return occlusion


def _mark(points, light, bricks, bias, occlusion) -> None:
    points = np.ascontiguousarray(points, np.float32)
    compiled = compiled_occlusion()
    if compiled:
        compiled(points, light, bricks, bias, occlusion)
    else:
        mark_occluded(points, light, bricks, np.float32(bias), occlusion)


@njit(cache=True, nogil=True, error_model="numpy")
def mark_occluded(
    points: np.ndarray,
    light: LightTables,
    bricks: FieldBricks,
    bias: np.float32,
    occlusion: np.ndarray,
) -> None:
    """Set `occlusion` (n,) of points (n, 3) float32 whose rays are in these tables.

    Args:
        bias: float32, how far the points are moved towards the light, in blocks of depth.
    """
    m, a, b = np.uint64(light.axes[0]), np.uint64(light.axes[1]), np.uint64(light.axes[2])
    f32, deep, near, sheet = np.float32, light.deep, light.near, bricks.sheet
    offsets, ends, ranges, slabs = light.offsets, light.ends, light.ranges, light.slabs
    # From points to depths, and to a and b from the first tile on, in blocks.
    brick = BRICK >> light.merged
    scale, far = f32(brick * bricks.size / 2), f32(deep)
    shift = brick * (bricks.size / 2 - bricks.corner)
    scale_m = -scale if light.back else scale
    shift_m = f32(deep - shift[m] if light.back else shift[m])
    shift_a, shift_b = f32(shift[a] - light.low[0]), f32(shift[b] - light.low[1])
    light_m, slope_a, slope_b = f32(light.source[0]), f32(light.source[1]), f32(light.source[2])
    light_a, light_b = f32(light.source[1] - light.low[0]), f32(light.source[2] - light.low[1])
    reach = far - light_m
    block, cell = CELL + light.merged, f32(1 << CELL)  # of a block in 2^−20 cells
    unit, per_slab = f32(1 << block), bricks.density << light.merged  # planes
    most, density, share = per_slab * deep, f32(per_slab), f32(1 / bricks.density)
    middle_a, middle_b = f32(light.middle[0]), f32(light.middle[1])
    low_a = light.low[0] + light.middle[0] << block
    low_b = light.low[1] + light.middle[1] << block
    rows = f32(len(offsets))
    step_m = (1 << CELL) // bricks.density
    step_m = -step_m if light.back else step_m
    start_m = (deep << block if light.back else 0) + (step_m >> 1)
    lit_planes = max(np.int64(np.ceil(per_slab * light.source[0] - 0.5)), 0) if near else 0
    nodes, shape = bricks.nodes.ravel(), bricks.nodes.shape
    field = nodes, shape, bricks.rows, bricks.masks, bricks.first, bricks.words
    for ray in range(len(points)):
        depth = points[ray, m] * scale_m + shift_m
        at_a, at_b = points[ray, a] * scale + shift_a, points[ray, b] * scale + shift_b
        left = far - depth
        if near:
            beyond, from_a, from_b = depth - light_m, at_a - light_a, at_b - light_b
            if not (0 < beyond < np.inf and abs(from_a) <= beyond and abs(from_b) <= beyond):
                continue
            slope_a, slope_b = from_a / beyond, from_b / beyond
            # From the closer end on: from far away rays round to tiles of other slopes.
            if depth - far > reach:
                at_a, at_b, left = light_a, light_b, reach
        u, v = at_a + slope_a * left, at_b + slope_b * left
        if not (u >= 0 and v >= 0 and u < rows):  # also for NaN
            continue
        row = np.int64(u)
        tile = offsets[row] + np.int64(v)
        if tile < ends[row] or tile >= ends[row + 1]:
            continue
        span = np.int64(ranges[tile])
        first = span & (1 << FIRST) - 1
        depth = min(depth - bias, far + f32(1))
        if depth <= f32(first):
            continue
        if depth > f32((span >> DARK) + 1):
            occlusion[ray] = True
            continue
        planes = min(np.int64(np.ceil(depth * density - _HALF)), most)
        # On the far side, and in the first plane.
        far_a = _fixed(u - middle_a, unit) + low_a
        far_b = _fixed(v - middle_b, unit) + low_b
        step_a, step_b = _fixed(slope_a * share, cell), _fixed(slope_b * share, cell)
        start_a = far_a - most * step_a + (step_a >> 1)
        start_b = far_b - most * step_b + (step_b >> 1)
        start = _in_order(m, start_m, start_a, start_b)
        step = _in_order(m, step_m, step_a, step_b)
        run = per_slab << (span >> DOUBLED & 7)  # planes of a bit
        span_of = per_slab * first, run, slabs[tile], lit_planes, planes
        if sheet:
            hit = _crosses(start, step, span_of, field)
        else:
            hit = _passes_inside(start, step, span_of, field)
        left = far - depth
        if not hit and left >= 0:
            end_a = far_a - _fixed(slope_a * left, unit)
            end_b = far_b - _fixed(slope_b * left, unit)
            end_m = _fixed(depth, unit)
            end_m = (deep << block) - end_m if light.back else end_m
            end = _in_order(m, end_m, end_a, end_b)
            if _is_within(end, bricks.shape):
                state = _state(end, field)
                if not sheet:
                    hit = state == INSIDE
                elif planes > lit_planes:
                    hit = _state(_sample(start, step, planes - 1), field) + state == _DIFFER
        occlusion[ray] |= hit


@njit(cache=True, nogil=True)
def _passes_inside(start, step, span, field):
    """Test a ray's samples."""
    first, run, bits, lit_planes, planes = span
    while bits:
        start_k = first + np.int64(trailing_zeros(bits)) * run
        bits &= bits - _ONE
        for k in range(max(start_k, lit_planes), min(start_k + run, planes)):
            if _state(_sample(start, step, k), field) == INSIDE:
                return True
    return False


@njit(cache=True, nogil=True)
def _crosses(start, step, span, field):
    """Test pairs of a ray's samples in succession, one of each pair in its slabs."""
    first, run, bits, lit_planes, planes = span
    before, last = OUTSIDE, -2
    while bits:
        start_k = first + np.int64(trailing_zeros(bits)) * run
        bits &= bits - _ONE
        for k in range(max(start_k - 1, lit_planes), min(start_k + run + 1, planes)):
            if k <= last:
                continue
            state = _state(_sample(start, step, k), field)
            if k == last + 1 and before + state == _DIFFER:
                return True
            before, last = state, k
    return False


@njit(cache=True, nogil=True)
def _sample(start, step, k):
    return start[0] + k * step[0], start[1] + k * step[1], start[2] + k * step[2]


@njit(cache=True, nogil=True)
def _in_order(m, at_m, at_a, at_b):
    """Coordinates x, y and z of those along m, a and b."""
    if m == 0:
        return at_m, at_a, at_b
    if m == 1:
        return at_b, at_m, at_a
    return at_a, at_b, at_m


@njit(cache=True, nogil=True)
def _fixed(length, unit):
    """Convert a length to 2^−20 cells, of which `unit` float32 are 1."""
    return np.int64(np.floor(length * unit + _HALF))


@njit(cache=True, nogil=True)
def _is_within(at, shape):
    """Test for the box without its outermost bricks, which are empty."""
    return (
        0 < at[0] >> BRICK_BITS < shape[0] - 1
        and 0 < at[1] >> BRICK_BITS < shape[1] - 1
        and 0 < at[2] >> BRICK_BITS < shape[2] - 1
    )


@njit(cache=True, nogil=True)
def _state(at, field):
    """`cell_state` at a position in the box, in 2^−20 cells."""
    nodes, shape, rows, masks, first, words = field
    x, y, z = at
    node = ((x >> NODE_BITS) * shape[1] + (y >> NODE_BITS)) * shape[2] + (z >> NODE_BITS)
    inner = (x >> BRICK_BITS & 3) << 4 | (y >> BRICK_BITS & 3) << 2 | z >> BRICK_BITS & 3
    row = rows[nodes[node] + inner]
    return cell_state(masks[row, 0], masks[row, 1], first[row], words, x, y, z)
