"""First crossing of rays with a field's surface, by CPU."""

import numpy as np
from numba import njit
from scipy import ndimage

from neural_shadows.representations.depths import LIT

BRICK = 4  # cells along a brick's axis
BRICK_VERTICES = (BRICK + 1) ** 3
SOLID = -(1 << 20)  # in the grid: a brick enclosed by the surface
# Samples of a ray along an axis. Four were no better on the Stanford dragon at 256³ (40.2 and 40.3
# dB), and each sample is a look-up.
SAMPLES_PER_CELL = 2
FAR = np.float32(1e9)  # radii, beyond everything
OUTSIDE, INSIDE, VOID = 0, 1, 2  # sides of a surface; void: where a sheet has none


def skips(surface: np.ndarray) -> np.ndarray:
    """Free bricks (B, B, B) int32 ahead of a ray.

    The chessboard distance to the nearest surface brick, at least 1.
    """
    if not surface.any():
        return np.full(surface.shape, len(surface), np.int32)
    distance = ndimage.distance_transform_cdt(~surface, "chessboard")
    return np.maximum(distance, 1).astype(np.int32)


@njit(cache=True, nogil=True)
def trilinear(values, at, across, along, u, v, w):
    """Interpolate flat values from corner `at` of a cell, with strides of u and v in [0, 1]."""
    a = np.float32(values[at])
    a += (values[at + 1] - a) * w
    b = np.float32(values[at + along])
    b += (values[at + along + 1] - b) * w
    c = np.float32(values[at + across])
    c += (values[at + across + 1] - c) * w
    e = np.float32(values[at + across + along])
    e += (values[at + across + along + 1] - e) * w
    a += (b - a) * v
    c += (e - c) * v
    return a + (c - a) * u


@njit(cache=True, nogil=True)
def _value(values, x, y, z):
    """Value of a brick at x, y, z in [0, 4]."""
    i, j, k = min(int(x), BRICK - 1), min(int(y), BRICK - 1), min(int(z), BRICK - 1)
    at = (i * (BRICK + 1) + j) * (BRICK + 1) + k
    return trilinear(values, at, 25, 5, x - i, y - j, z - k)


@njit(cache=True, nogil=True)
def _has_sides(cells, values, level, x, y, z):
    """Test a sheet's cell at x, y, z in [0, 1] of a brick: touched, or all on one side."""
    most = np.int64(BRICK - 1)
    i, j, k = min(int(x * BRICK), most), min(int(y * BRICK), most), min(int(z * BRICK), most)
    i, j, k = max(i, 0), max(j, 0), max(k, 0)
    if cells >> np.uint64(BRICK**2 * i + BRICK * j + k) & np.uint64(1):
        return True
    at, positive = (i * (BRICK + 1) + j) * (BRICK + 1) + k, 0
    for c in (0, 1, 5, 6, 25, 26, 30, 31):
        positive += values[at + c] > level
    return positive == 0 or positive == 8


@njit(cache=True, nogil=True, error_model="numpy")
def _crossing(ox, oy, oz, dx, dy, dz, first, end, step, grid, bricks, cells, level):
    """First crossing of a ray with the surface; `end` for none.

    The ray is o + t d, in bricks from the corner −1; sample i, from `first` on, is at t = (i + 0.5)
    step.
    """
    size, sheet, sided = len(grid), len(cells) > 0, False
    # Inverses: 0 for an axis the ray does not move along, which never ends a brick.
    ix = 1 / dx if abs(dx) > 1e-9 else np.float32(0)
    iy = 1 / dy if abs(dy) > 1e-9 else np.float32(0)
    iz = 1 / dz if abs(dz) > 1e-9 else np.float32(0)
    ahead_x, ahead_y, ahead_z = dx > 0, dy > 0, dz > 0
    zero, half, brick_cells = np.float32(0), np.float32(0.5), np.float32(BRICK)
    i = first
    last_sample = first - 2  # of the value `before`
    before = zero
    t = (i + half) * step
    while t < end:
        x, y, z = ox + t * dx, oy + t * dy, oz + t * dz
        bx = min(max(int(x), 0), size - 1)
        by = min(max(int(y), 0), size - 1)
        bz = min(max(int(z), 0), size - 1)
        brick = grid[bx, by, bz]
        if brick == SOLID:
            return t
        # Exit of the ray from the brick, or from the empty cube of bricks around it.
        free = -brick if brick < 0 else 1
        ex = (bx + free if ahead_x else bx + 1 - free) - x
        ey = (by + free if ahead_y else by + 1 - free) - y
        ez = (bz + free if ahead_z else bz + 1 - free) - z
        tx = ex * ix if ix != 0 else FAR
        ty = ey * iy if iy != 0 else FAR
        tz = ez * iz if iz != 0 else FAR
        leave = t + max(min(tx, ty, tz), zero)
        if brick < 0:
            i = max(i + 1, int(np.ceil(leave / step - half)))
            t = (i + half) * step
            continue
        values = bricks[brick]
        while True:
            value = _value(
                values,
                min(max((x - bx) * brick_cells, zero), brick_cells),
                min(max((y - by) * brick_cells, zero), brick_cells),
                min(max((z - bz) * brick_cells, zero), brick_cells),
            )
            crossed = value > level
            if sheet:
                sided_before = sided
                sided = _has_sides(cells[brick], values, level, x - bx, y - by, z - bz)
                crossed = last_sample == i - 1 and crossed != (before > level)
                crossed = crossed and sided and sided_before
            if crossed:
                if last_sample == i - 1:
                    return t - step * (value - level) / (value - before)
                return t
            before, last_sample = value, i
            i += 1
            t = (i + half) * step
            if t >= leave or t >= end:
                break
            x, y, z = ox + t * dx, oy + t * dy, oz + t * dz
    return end


NO_CELLS = np.empty(0, np.uint64)  # of a solid


def all_cells(bricks: np.ndarray) -> np.ndarray:
    """Cells of a sheet that may be crossed anywhere in its bricks; see `first_crossings`."""
    return np.full(len(bricks), ~np.uint64(0))


@njit(cache=True, nogil=True)
def first_crossings(origins, d, grid, bricks, steps, cells, level):
    """t_pred (k,) float32 of parallel rays; `LIT` for misses.

    Args:
        origins: (k, 3) float32, on the unit sphere.
        d: (3,) float32 unit vector, pointing inward.
        grid: (B, B, B) int32, see `BrickLayout`.
        bricks: (bricks, 125), values of each brick's vertices on any one scale.
        steps: samples on a diameter; sample i lies at t = 2 (i + 0.5) / steps.
        cells: of a sheet (bricks,) uint64, bit 16 x + 4 y + z for each cell that may be crossed; of
            a solid `NO_CELLS`. A sheet is crossed at any change of sign, but where other cells have
            corners of both signs; a solid above the level.
        level: float32, the value at the surface, on the scale of `bricks`.
    """
    t_pred = np.empty(len(origins), np.float32)
    scale = np.float32(len(grid) / 2)  # bricks a radius
    step = np.float32(2 / steps)
    dx, dy, dz = d[0] * scale, d[1] * scale, d[2] * scale
    for ray in range(len(origins)):
        o = origins[ray]
        chord = -2 * (o[0] * d[0] + o[1] * d[1] + o[2] * d[2])
        ox, oy, oz = (o[0] + 1) * scale, (o[1] + 1) * scale, (o[2] + 1) * scale
        t = _crossing(ox, oy, oz, dx, dy, dz, 0, chord, step, grid, bricks, cells, level)
        t_pred[ray] = t if t < chord else np.float32(LIT)
    return t_pred


@njit(cache=True, nogil=True, error_model="numpy")
def mark_blocked(points, to_target, grid, bricks, steps, cells, level, blocked):
    """Mark in `blocked` (n,) bool segments through a field's surface.

    Args:
        points, to_target: (n, 3) float32 in radii of the field's sphere; `to_target` from each
            point to the end of its segment. One of no length or a NaN is not blocked.
        grid, bricks, steps, cells, level: see `first_crossings`. Already blocked ones are skipped.
    """
    one, half = np.float32(1), np.float32(0.5)
    scale, step = np.float32(len(grid) / 2), np.float32(2 / steps)
    for ray in range(len(points)):
        if blocked[ray]:
            continue
        x, y, z = points[ray]
        u, v, w = to_target[ray]
        length = np.sqrt(u * u + v * v + w * w)
        u, v, w = u / length, v / length, w / length
        # The part inside the sphere, by distances from the point next to its middle: squares of
        # far points' distances would cancel.
        along = x * u + y * v + z * w
        a, b, c = x - along * u, y - along * v, z - along * w
        inside = one - (a * a + b * b + c * c)
        if not inside > 0:  # also for NaN
            continue
        root = np.sqrt(inside)
        begin, end = max(along, -root), min(along + length, root)
        if begin >= end:
            continue
        # From the light to the point.
        length = end - begin
        x, y, z = a + end * u, b + end * v, c + end * w
        t = _crossing(
            (x + one) * scale, (y + one) * scale, (z + one) * scale,
            -u * scale, -v * scale, -w * scale,
            0, length, step, grid, bricks, cells, level,
        )  # fmt: skip
        if t < length:
            blocked[ray] = True
            continue
        field = grid, bricks, cells, level
        side = _side(a + begin * u, b + begin * v, c + begin * w, field)
        if len(cells) == 0:
            blocked[ray] = side == INSIDE
            continue
        last = (np.ceil(length / step - half) - half) * step  # the last sample
        if last > 0:
            side += _side(x - last * u, y - last * v, z - last * w, field)
            blocked[ray] = side == OUTSIDE + INSIDE


@njit(cache=True, nogil=True)
def _side(x, y, z, field):
    """`OUTSIDE`, `INSIDE` or `VOID` at a position in [−1, 1]³."""
    grid, bricks, cells, level = field
    size, scale = len(grid), np.float32(len(grid) / 2)
    zero, one, brick_cells = np.float32(0), np.float32(1), np.float32(BRICK)
    x, y, z = (x + one) * scale, (y + one) * scale, (z + one) * scale
    bx = min(max(int(x), 0), size - 1)
    by = min(max(int(y), 0), size - 1)
    bz = min(max(int(z), 0), size - 1)
    brick = grid[bx, by, bz]
    if brick == SOLID:
        return INSIDE
    if brick < 0:
        return VOID
    values = bricks[brick]
    if len(cells) and not _has_sides(cells[brick], values, level, x - bx, y - by, z - bz):
        return VOID
    value = _value(
        values,
        min(max((x - bx) * brick_cells, zero), brick_cells),
        min(max((y - by) * brick_cells, zero), brick_cells),
        min(max((z - bz) * brick_cells, zero), brick_cells),
    )
    return INSIDE if value > level else OUTSIDE
