"""Training rays of one view direction, by the sampling methods of table 4.1 [3.4.2]."""

import math

import numpy as np
from numba import njit

from neural_shadows.rays.poisson_disk import PatternBank
from neural_shadows.rays.quadtree import DISK_RADIUS, build_quadtree, disk_area
from neural_shadows.rays.silhouette import entry_points, silhouette
from neural_shadows.scenes.tracing import Tracer
from neural_shadows.settings.records import SamplingSettings


def sample_direction(
    tracer: Tracer,
    direction: np.ndarray,
    sampling: SamplingSettings,
    *,
    rng: np.random.Generator,
    bank: PatternBank,
) -> np.ndarray:
    """Origins of the rays along one direction d (3,) [3.4.2].

    Args:
        sampling: `sampler`; `points_per_direction` m; and, unless the sampler is `uniform`,
            `silhouette_resolution` and `min_quad` in texels, powers of two.
        rng: used for this direction alone; bank: by `poisson_quadtree` alone.

    Returns:
        (m, 3) float32 on the unit sphere, o·d <= −1e-3. Rays of a quad follow each other.
    """
    sampler, m = sampling["sampler"], sampling["points_per_direction"]
    direction = direction.astype(np.float64)
    direction /= np.linalg.norm(direction)
    if sampler == "uniform":
        return entry_points(direction, uniform_on_disk(m, rng))
    resolution = sampling["silhouette_resolution"]
    quads = build_quadtree(silhouette(tracer, direction, resolution), sampling["min_quad"])
    patterns = {"poisson_quadtree": bank, "uniform_quadtree": None}[sampler]
    return entry_points(direction, sample_quads(quads, resolution, m, rng, patterns))


def sample_quads(
    quads: np.ndarray,
    resolution: int,
    m: int,
    rng: np.random.Generator,
    bank: PatternBank | None,
) -> np.ndarray:
    """Draw m points, divided evenly over q quads.

    The density in a quad is p(a, b) = 1 / (q · area(quad ∩ disk)).

    Each quad gets ⌊m/q⌋ points, and randomly chosen quads get one of the remainder. Within its
    quad a point is uniform over the part inside the disk of `DISK_RADIUS`.

    Args:
        quads: (q, 3) as of `build_quadtree`, of a silhouette of `resolution`² texels.
        bank: the Poisson-disk patterns of the quads; without it points are independent. In
            quads cut by the disk's rim the pattern is stretched over the box
            around the rest, drawn denser, and thinned at random to the points inside.

    Returns:
        (m, 2) float64 offsets (a, b), in the order of the quads.
    """
    counts = _divide(m, len(quads), rng)
    boxes, areas = _regions(quads, resolution)
    if bank is None:
        return _place_uniform(counts, boxes, rng)
    sizes = _pattern_sizes(counts, boxes, areas)
    return _place_patterns(counts, boxes, sizes, *bank.table(sizes), rng)


@njit(cache=True, nogil=True)
def uniform_on_disk(m, rng):
    """Draw m uniform points (m, 2), float64, in the disk of `DISK_RADIUS`."""
    offsets = np.empty((m, 2))
    for i in range(m):
        distance = DISK_RADIUS * math.sqrt(rng.random())
        angle = 2 * math.pi * rng.random()
        offsets[i, 0], offsets[i, 1] = distance * math.cos(angle), distance * math.sin(angle)
    return offsets


@njit(cache=True, nogil=True)
def _divide(m, q, rng):
    """Divide m points evenly; the remainder to a uniform subset."""
    counts = np.full(q, m // q)
    left = m % q
    for i in range(q):
        if rng.random() * (q - i) < left:
            counts[i] += 1
            left -= 1
    return counts


@njit(cache=True, nogil=True)
def _regions(quads, resolution):
    """Boxes (left, bottom, right, top) and areas of quads in the disk."""
    boxes = np.empty((len(quads), 4))
    areas = np.empty(len(quads))
    for i in range(len(quads)):
        row, column, size = quads[i]
        left, right = 2 * column / resolution - 1, 2 * (column + size) / resolution - 1
        bottom, top = 2 * row / resolution - 1, 2 * (row + size) / resolution - 1
        area = disk_area(left, bottom, right, top)
        near_a, near_b = max(left, -right, 0.0), max(bottom, -top, 0.0)
        reach_a = math.sqrt(DISK_RADIUS**2 - near_b**2)
        reach_b = math.sqrt(DISK_RADIUS**2 - near_a**2)
        left, right = max(left, -reach_a), min(right, reach_a)
        bottom, top = max(bottom, -reach_b), min(top, reach_b)
        # As a whole, rows take numba seconds to compile.
        boxes[i, 0], boxes[i, 1], boxes[i, 2], boxes[i, 3] = left, bottom, right, top
        # A convex region fills half of its box at least: a bound for slivers, whose area is
        # lost in the rounding of `disk_area`.
        areas[i] = max(area, (right - left) * (top - bottom) / 2)
    return boxes, areas


@njit(cache=True, nogil=True)
def _is_inside(a, b):
    return a * a + b * b < DISK_RADIUS * DISK_RADIUS


@njit(cache=True, nogil=True)
def _is_whole(box):
    """Test whether a box is inside the disk."""
    left, bottom, right, top = box
    return _is_inside(max(-left, right), max(-bottom, top))


@njit(cache=True, nogil=True)
def _place_uniform(counts, boxes, rng):
    offsets = np.empty((counts.sum(), 2))
    placed = 0
    for i in range(len(counts)):
        left, bottom, right, top = boxes[i]
        for _ in range(counts[i]):
            while True:
                a = left + (right - left) * rng.random()
                b = bottom + (top - bottom) * rng.random()
                if _is_inside(a, b):
                    break
            offsets[placed, 0], offsets[placed, 1] = a, b
            placed += 1
    return offsets


@njit(cache=True, nogil=True)
def _pattern_sizes(counts, boxes, areas):
    """Numbers of points in the patterns of quads' boxes."""
    sizes = np.zeros(len(counts), np.int64)
    for i in range(len(counts)):
        n = counts[i]
        if n == 0:
            continue
        if not _is_whole(boxes[i]):
            left, bottom, right, top = boxes[i]
            # Enough that few draws leave less than n inside: their number scatters by about
            # n^(1/4), the square root of the rim's length in spacings.
            share = areas[i] / ((right - left) * (top - bottom))
            n = math.ceil((n + 1 + 1.5 * n**0.25) / share)
        # 32 sizes an octave, so that the bank stays small: 3 % too many at most.
        grain = 1
        while n > 64 * grain:
            grain *= 2
        sizes[i] = (n + grain - 1) // grain * grain
    return sizes


@njit(cache=True, nogil=True)
def _place_patterns(counts, boxes, sizes, start, patterns, points, rng):
    offsets = np.empty((counts.sum(), 2))
    laid = np.empty((sizes.max(), 2))
    placed = 0
    for i in range(len(counts)):
        n, size = counts[i], sizes[i]
        if n == 0:
            continue  # fewer points than quads: the loop below would not end
        whole = _is_whole(boxes[i])
        while True:
            first = start[size] + size * int(patterns[size] * rng.random())
            inside = _fill_pattern(points[first : first + size], boxes[i], whole, rng, laid)
            # Draws with more points inside would give each of them a smaller chance to be
            # kept, n / inside; accepted in proportion to `inside`, every place has the same.
            if whole or (inside >= n and rng.random() * size < inside):
                break
        wanted = n
        for j in range(inside):
            if rng.random() * (inside - j) < wanted:
                offsets[placed, 0], offsets[placed, 1] = laid[j, 0], laid[j, 1]
                placed += 1
                wanted -= 1
    return offsets


@njit(cache=True, nogil=True)
def _fill_pattern(pattern, box, whole, rng, out):
    """Fill `out` with a random pattern's points in box and disk."""
    left, bottom, right, top = box
    symmetry = int(8 * rng.random())
    shift_x, shift_y = rng.random(), rng.random()
    inside = 0
    for i in range(len(pattern)):
        x, y = pattern[i]
        if symmetry & 1:
            x, y = y, x
        if symmetry & 2:
            x = 1 - x
        if symmetry & 4:
            y = 1 - y
        x, y = x + shift_x, y + shift_y
        a = left + (right - left) * (x - 1 if x >= 1 else x)
        b = bottom + (top - bottom) * (y - 1 if y >= 1 else y)
        if whole or _is_inside(a, b):
            out[inside, 0], out[inside, 1] = a, b
            inside += 1
    return inside
