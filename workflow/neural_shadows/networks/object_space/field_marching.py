"""The first crossing of rays with an occupancy field, on a CPU."""

import numpy as np
from numba import njit
from scipy import ndimage

from neural_shadows.networks.object_space.shadow_network import LIT

BRICK = 4  # cells along a brick's axis
BRICK_VERTICES = (BRICK + 1) ** 3
SOLID = -(1 << 20)  # in the grid: the brick is enclosed by the surface


def skips(surface: np.ndarray) -> np.ndarray:
    """How many bricks (B, B, B) int32 a ray may go on before it can meet one that holds values.

    The chessboard distance to the nearest, at least 1.
    """
    if not surface.any():
        return np.full(surface.shape, len(surface), np.int32)
    distance = ndimage.distance_transform_cdt(~surface, "chessboard")
    return np.maximum(distance, 1).astype(np.int32)


@njit(cache=True, nogil=True, inline="always")
def _value(values, x, y, z):
    """A brick's value at x, y, z in [0, 4]."""
    i, j, k = min(int(x), BRICK - 1), min(int(y), BRICK - 1), min(int(z), BRICK - 1)
    u, v, w = x - i, y - j, z - k
    at = (i * (BRICK + 1) + j) * (BRICK + 1) + k
    a = np.float32(values[at])
    a += (values[at + 1] - a) * w
    b = np.float32(values[at + 5])
    b += (values[at + 6] - b) * w
    c = np.float32(values[at + 25])
    c += (values[at + 26] - c) * w
    e = np.float32(values[at + 30])
    e += (values[at + 31] - e) * w
    a += (b - a) * v
    c += (e - c) * v
    return a + (c - a) * u


@njit(cache=True, nogil=True)
def first_crossings(origins, d, grid, bricks, steps, sheet, level):
    """t_pred (k,) float32 of parallel rays; `LIT` where there is no crossing.

    Args:
        origins: (k, 3) float32, on the unit sphere.
        d: (3,) float32 unit vector, pointing inward.
        grid: (B, B, B) int32, see `occupancy_field_network.BrickLayout`.
        bricks: (bricks, 125), values of each brick's vertices on any one scale.
        steps: samples on a diameter; sample i lies at t = 2 (i + 0.5) / steps.
        sheet: whether any change of sign counts, or a value above the level.
        level: float32, the value at the surface, on the scale of `bricks`.
    """
    t_pred = np.empty(len(origins), np.float32)
    size = len(grid)
    scale = np.float32(size / 2)  # bricks a radius
    step = np.float32(2 / steps)
    # Bricks along each axis for a step of t, and its inverse: 0 for an axis that the ray does
    # not move on, which is set apart below since it never ends a brick.
    dx, dy, dz = d[0] * scale, d[1] * scale, d[2] * scale
    ix = 1 / dx if abs(dx) > 1e-9 else np.float32(0)
    iy = 1 / dy if abs(dy) > 1e-9 else np.float32(0)
    iz = 1 / dz if abs(dz) > 1e-9 else np.float32(0)
    far = np.float32(4)  # beyond any chord
    lit = np.float32(LIT)
    ahead_x, ahead_y, ahead_z = d[0] > 0, d[1] > 0, d[2] > 0
    zero, half, brick_cells = np.float32(0), np.float32(0.5), np.float32(BRICK)
    for ray in range(len(origins)):
        o = origins[ray]
        chord = -2 * (o[0] * d[0] + o[1] * d[1] + o[2] * d[2])
        ox, oy, oz = (o[0] + 1) * scale, (o[1] + 1) * scale, (o[2] + 1) * scale
        found = lit
        i = 0
        known = -2  # the sample whose value is `before`
        before = zero
        t = half * step
        while t < chord:
            x, y, z = ox + t * dx, oy + t * dy, oz + t * dz
            bx = min(max(int(x), 0), size - 1)
            by = min(max(int(y), 0), size - 1)
            bz = min(max(int(z), 0), size - 1)
            brick = grid[bx, by, bz]
            if brick == SOLID:
                found = t
                break
            # Where the ray leaves the brick, or the empty cube of bricks around it.
            free = -brick if brick < 0 else 1
            ex = (bx + free if ahead_x else bx + 1 - free) - x
            ey = (by + free if ahead_y else by + 1 - free) - y
            ez = (bz + free if ahead_z else bz + 1 - free) - z
            tx = ex * ix if ix != 0 else far
            ty = ey * iy if iy != 0 else far
            tz = ez * iz if iz != 0 else far
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
                    crossed = known == i - 1 and crossed != (before > level)
                if crossed:
                    found = t
                    if known == i - 1:
                        found -= step * (value - level) / (value - before)
                    break
                before, known = value, i
                i += 1
                t = (i + half) * step
                if t >= leave or t >= chord:
                    break
                x, y, z = ox + t * dx, oy + t * dy, oz + t * dz
            if found < lit:
                break
        t_pred[ray] = found
    return t_pred
