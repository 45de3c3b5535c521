"""Poisson-disk sampling by Bridson's active list: on the sphere and on the unit torus [3.4.1].

R. Bridson, "Fast Poisson disk sampling in arbitrary dimensions", SIGGRAPH 2007 sketches.
"""

import math
import threading
from collections.abc import Sequence

import numpy as np
from numba import njit

# Candidates tried around a point before it leaves the active list (Bridson's k).
CANDIDATES = 30

# n · r² / area of Bridson's sets of n points is 0.615, and scatters by 0.2 / √n of itself
# (measured at k = 30, on the sphere and on the torus).
_DENSITY = 0.615

# Patterns stored of n points: 32 of few points. A pattern of many has enough variety by itself.
_PATTERNS = 32
_PATTERNS_LEAST = 4
_PATTERN_POINTS = 1024


@njit(cache=True, nogil=True)
def poisson_disk(radius, rng, on_sphere):
    """Fill the unit sphere or torus with points `radius` apart [3.4.1].

    Distances on the torus wrap around, so that the set, shifted uniformly (modulo 1), has the
    same density everywhere. In a bounded square Bridson's points crowd at the edges.

    Args:
        radius: smallest distance r, on the sphere along the chord, in (0, 2]; or in (0, 1].

    Returns:
        float64 unit vectors (n, 3), or points (n, 2) in [0, 1)².
    """
    # Caps of chord radius r / 2, or disks of it, do not overlap: fewer than this fit.
    capacity = int(16 / radius**2) if on_sphere else int(2 / radius**2)
    # Bins are cubes or squares of side r at least, hashed because the sphere meets few of those in
    # its box: the latest point in each bucket, and for each point the one before it.
    buckets = 1
    while buckets < 2 * capacity:
        buckets *= 2
    latest = np.full(buckets, -1)
    before = np.empty(capacity, np.int64)
    side = math.ceil(2 / radius) + 2 if on_sphere else int(1 / radius)
    scale = 1 / radius if on_sphere else float(side)

    if on_sphere:
        candidate = np.array([rng.normal(), rng.normal(), rng.normal()])
        candidate /= np.linalg.norm(candidate)
    else:
        candidate = np.array([rng.random(), rng.random()])
    points = np.empty((capacity, len(candidate)))
    active = np.empty(capacity, np.int64)
    _insert(candidate, 0, scale, points, latest, before)
    active[0] = 0
    count = active_count = 1
    while active_count > 0:
        chosen = int(rng.random() * active_count)
        parent = points[active[chosen]]
        for _ in range(CANDIDATES):
            if on_sphere:
                _draw_on_sphere(parent, radius, rng, candidate)
            else:
                _draw_on_torus(parent, radius, rng, candidate)
            if _is_free(candidate, radius, scale, side, points, latest, before):
                _insert(candidate, count, scale, points, latest, before)
                active[active_count] = count
                count += 1
                active_count += 1
                break
        else:
            active_count -= 1
            active[chosen] = active[active_count]
    return points[:count].copy()


def sphere_directions(count, seed):
    """A Poisson-disk pattern on the unit sphere: (count, 3) float64, and its radius [3.4.1]."""
    return exactly(count, np.random.default_rng(seed), True)


class PatternBank:
    """Poisson-disk patterns on the unit torus, made on first use; thread-safe.

    The patterns of a count of points depend on the seed (numpy's) and that count alone.
    """

    def __init__(self, seed: int | Sequence[int]):
        self._seed = seed
        self._lock = threading.Lock()
        # Of 0 points there is one pattern, the empty one.
        self._counts = {0}
        self._table = (np.zeros(1, np.int64), np.ones(1, np.int64), np.empty((0, 2)))

    def table(self, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """All patterns so far, among them those of `counts` points (int64).

        Returns:
            start, patterns: (N,) int64; points: (P, 2) float64 in [0, 1)². Pattern
            j < patterns[n] of n points is the n rows of `points` from start[n] + j·n.
        """
        with self._lock:
            for count in set(counts.tolist()) - self._counts:
                self._add(count)
            return self._table

    def _add(self, count: int) -> None:
        start, patterns, points = self._table
        grown = np.zeros((2, max(len(start), count + 1)), np.int64)
        grown[:, : len(start)] = start, patterns
        number = int(np.clip(_PATTERN_POINTS // count, _PATTERNS_LEAST, _PATTERNS))
        grown[:, count] = len(points), number
        rng = np.random.default_rng(np.random.SeedSequence(self._seed, spawn_key=(count,)))
        new = [exactly(count, rng, False)[0] for _ in range(number)]
        self._table = (grown[0], grown[1], np.concatenate([points, *new]))
        self._counts.add(count)


@njit(cache=True, nogil=True)
def exactly(count, rng, on_sphere):
    """A set of `count` points on the sphere or the torus, and its r.

    r goes down until there are `count` points, or a few more: those are dropped at random.
    """
    # From half a standard deviation above the wanted count down, in steps of one.
    scatter = 0.2 / math.sqrt(count)
    area = 4 * math.pi if on_sphere else 1.0
    radius = math.sqrt(area * _DENSITY * (1 - 0.5 * scatter) / count)
    if on_sphere:
        radius = min(radius, 2.0)
    step = 1 - 0.5 * scatter
    while True:
        points = poisson_disk(radius, rng, on_sphere)
        if len(points) >= count:
            break
        radius *= step
    # Each point stays with the chance (still wanted) / (still left): a uniform subset.
    selected = 0
    for i in range(len(points)):
        if rng.random() * (len(points) - i) < count - selected:
            for axis in range(points.shape[1]):
                points[selected, axis] = points[i, axis]
            selected += 1
    return points[:count].copy(), radius


@njit(cache=True, nogil=True)
def _bin(point, scale):
    """Bin of a point in the sphere's box [−1, 1]³, or on the torus."""
    if len(point) == 2:
        return int(point[0] * scale), int(point[1] * scale), 0
    return int((point[0] + 1) * scale), int((point[1] + 1) * scale), int((point[2] + 1) * scale)


@njit(cache=True, nogil=True)
def _bucket(i, j, k, buckets):
    # Primes of Teschner et al. 2003; `buckets` is a power of two.
    return (i * 73856093 ^ j * 19349663 ^ k * 83492791) & (buckets - 1)


@njit(cache=True, nogil=True)
def _insert(point, index, scale, points, latest, before):
    for axis in range(len(point)):  # assigning rows takes numba 4 s to compile
        points[index, axis] = point[axis]
    i, j, k = _bin(point, scale)
    bucket = _bucket(i, j, k, len(latest))
    before[index] = latest[bucket]
    latest[bucket] = index


@njit(cache=True, nogil=True)
def _is_free(point, radius, scale, side, points, latest, before):
    on_sphere = len(point) == 3
    column, row, layer = _bin(point, scale)
    layers = 1 if on_sphere else 0
    for i in range(column - 1, column + 2):
        i += side if i < 0 else -side if i >= side else 0  # much faster than i % side
        for j in range(row - 1, row + 2):
            j += side if j < 0 else -side if j >= side else 0
            for k in range(layer - layers, layer + layers + 1):
                other = latest[_bucket(i, j, k, len(latest))]
                while other >= 0:
                    squared = 0.0
                    for axis in range(len(point)):
                        apart = abs(points[other, axis] - point[axis])
                        if not on_sphere:
                            apart = min(apart, 1 - apart)
                        squared += apart * apart
                    if squared < radius * radius:
                        return False
                    other = before[other]
    return True


@njit(cache=True, nogil=True)
def _draw_on_torus(centre, radius, rng, out):
    """Draw a torus point at r to 2r from `centre`, uniform in area."""
    distance = radius * math.sqrt(1 + 3 * rng.random())
    angle = 2 * math.pi * rng.random()
    out[0] = centre[0] + distance * math.cos(angle)
    out[1] = centre[1] + distance * math.sin(angle)
    for axis in range(2):
        out[axis] -= math.floor(out[axis])
        if out[axis] >= 1:  # a tiny negative number, less its floor, is rounded to 1
            out[axis] = 0.0


@njit(cache=True, nogil=True)
def _draw_on_sphere(centre, radius, rng, out):
    """Draw a sphere point with a chord of r to 2r, uniform in area."""
    # The cap within a chord c has the area π c², so c² is uniform; on the axis 1 − c² / 2.
    chord2 = radius**2 * (1 + rng.random() * (min(4.0, 4 / radius**2) - 1))
    along = 1 - chord2 / 2
    # A random vector less its part along the centre: a uniform direction across.
    out[0], out[1], out[2] = rng.normal(), rng.normal(), rng.normal()
    out -= np.dot(out, centre) * centre
    out *= math.sqrt(max(0.0, 1 - along * along)) / np.linalg.norm(out)
    out += along * centre
    out /= np.linalg.norm(out)
