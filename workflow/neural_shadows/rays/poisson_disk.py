"""Poisson-disk sampling by Bridson's active list: on the sphere and on the unit torus [3.4.1].

R. Bridson, "Fast Poisson disk sampling in arbitrary dimensions", SIGGRAPH 2007 sketches.
"""

import math
import threading
from collections.abc import Sequence

import numpy as np
from numba import njit

# Candidates that are tried around a point before it leaves the active list (Bridson's k).
CANDIDATES = 30

# n · r² / area of Bridson's sets of n points is 0.615, and scatters by 0.2 / √n of itself
# (measured at k = 30, on the sphere and on the torus).
_DENSITY = 0.615

# Patterns that are kept of n points: 32 of few points. A pattern of many gives its uses
# enough variety by itself.
_PATTERNS = 32
_PATTERNS_LEAST = 4
_PATTERN_POINTS = 1024


@njit(cache=True, nogil=True)
def poisson_disk_sphere(radius, rng):
    """Points on the unit sphere, none closer than `radius`, until no more are found [3.4.1].

    Args:
        radius: smallest distance r, along the chord, in (0, 2].
        rng: numpy Generator.

    Returns:
        (n, 3) float64 unit vectors, in the order in which they were found.
    """
    # Caps of chord radius r / 2 (area π r² / 4) do not overlap: fewer than this fit.
    capacity = int(16 / radius**2)
    points = np.empty((capacity, 3))
    active = np.empty(capacity, np.int64)
    # Bins are cubes of side r, hashed because the sphere meets few of those in its box: the
    # latest point in each bucket, and for each point the one before it.
    buckets = 1
    while buckets < 2 * capacity:
        buckets *= 2
    latest = np.full(buckets, -1)
    before = np.empty(capacity, np.int64)

    first = np.array([rng.normal(), rng.normal(), rng.normal()])
    candidate = first / np.linalg.norm(first)
    _insert_on_sphere(candidate, 0, radius, points, latest, before)
    active[0] = 0
    count = active_count = 1
    while active_count > 0:
        chosen = int(rng.random() * active_count)
        parent = points[active[chosen]]
        for _ in range(CANDIDATES):
            _draw_around(parent, radius, rng, candidate)
            if _is_free_on_sphere(candidate, radius, points, latest, before):
                _insert_on_sphere(candidate, count, radius, points, latest, before)
                active[active_count] = count
                count += 1
                active_count += 1
                break
        else:
            active_count -= 1
            active[chosen] = active[active_count]
    return points[:count].copy()


@njit(cache=True, nogil=True)
def poisson_disk_torus(radius, rng):
    """Points on the unit torus, none closer than `radius`, until no more are found [3.4.1].

    Distances wrap around, so that the set, shifted uniformly (modulo 1), has the same density
    everywhere. In a bounded square Bridson's points crowd at the edges.

    Args:
        radius: smallest distance r, in (0, 1].
        rng: numpy Generator.

    Returns:
        (n, 2) float64 in [0, 1)², in the order in which they were found.
    """
    # Bins whose diagonal is at most r hold one point at most.
    side = math.ceil(math.sqrt(2) / radius)
    reach = math.ceil(radius * side)
    bins = np.full((side, side), -1)
    points = np.empty((side * side, 2))
    active = np.empty(side * side, np.int64)

    x, y = rng.random(), rng.random()
    points[0] = x, y
    bins[int(x * side), int(y * side)] = 0
    active[0] = 0
    count = active_count = 1
    while active_count > 0:
        chosen = int(rng.random() * active_count)
        parent = points[active[chosen]]
        for _ in range(CANDIDATES):
            distance = radius * math.sqrt(1 + 3 * rng.random())  # uniform in area
            angle = 2 * math.pi * rng.random()
            x = _wrap(parent[0] + distance * math.cos(angle))
            y = _wrap(parent[1] + distance * math.sin(angle))
            if _is_free_on_torus(x, y, radius, reach, points, bins):
                points[count] = x, y
                bins[int(x * side), int(y * side)] = count
                active[active_count] = count
                count += 1
                active_count += 1
                break
        else:
            active_count -= 1
            active[chosen] = active[active_count]
    return points[:count].copy()


def sphere_directions(count, seed):
    """Exactly `count` directions in a Poisson-disk pattern on the unit sphere [3.4.1].

    Returns:
        directions: (count, 3) float64 unit vectors.
        radius: r, the chord that no two of them are closer than.
    """
    return exactly(count, np.random.default_rng(seed), True)


class PatternBank:
    """Poisson-disk patterns on the unit torus, made when first asked for; threads may share it.

    What it holds for a count of points depends on the seed and that count alone.

    Args:
        seed: an integer or some, as of numpy's SeedSequence.
    """

    def __init__(self, seed: int | Sequence[int]):
        self._seed = seed
        self._lock = threading.Lock()
        # Of 0 points there is one pattern, the empty one.
        self._table = (np.zeros(1, np.int64), np.ones(1, np.int64), np.empty((0, 2)))

    def table(self, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """All patterns made so far, with those of `counts` points among them.

        Args:
            counts: int64, any shape.

        Returns:
            start, patterns: (N,) int64; points: (P, 2) float64 in [0, 1)². Pattern
            j < patterns[n] of n points is the n rows of `points` from start[n] + j·n.
        """
        table = self._table
        if not _holds(table, counts):
            with self._lock:
                for count in np.unique(counts):
                    if not _holds(self._table, count):
                        self._table = self._extended(int(count))
                table = self._table
        return table

    def _extended(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A copy of the table with the patterns of `count` points added."""
        start, patterns, points = self._table
        grown = np.zeros((2, max(len(start), count + 1)), np.int64)
        grown[:, : len(start)] = start, patterns
        number = int(np.clip(_PATTERN_POINTS // count, _PATTERNS_LEAST, _PATTERNS))
        grown[:, count] = len(points), number
        rng = np.random.default_rng(np.random.SeedSequence(self._seed, spawn_key=(count,)))
        new = [exactly(count, rng, False)[0] for _ in range(number)]
        return grown[0], grown[1], np.concatenate([points, *new])


def _holds(table, counts) -> bool:
    """Whether the table has patterns of all these counts."""
    patterns = table[1]
    return np.max(counts) < len(patterns) and bool(np.all(patterns[counts]))


@njit(cache=True, nogil=True)
def exactly(count, rng, on_sphere):
    """`count` points of the first set, on the sphere or the torus, that has as many; and its r.

    r goes down until `count` points come out, or a few more: those are dropped at random.
    """
    # From half a standard deviation above the wanted count down, in steps of one.
    scatter = 0.2 / math.sqrt(count)
    area = 4 * math.pi if on_sphere else 1.0
    radius = math.sqrt(area * _DENSITY * (1 - 0.5 * scatter) / count)
    if on_sphere:
        radius = min(radius, 2.0)
    step = 1 - 0.5 * scatter
    while True:
        if on_sphere:
            points = poisson_disk_sphere(radius, rng)
        else:
            points = poisson_disk_torus(radius, rng)
        if len(points) >= count:
            break
        radius *= step
    # Each point stays with the chance (still wanted) / (still there): a uniform subset.
    kept = 0
    for i in range(len(points)):
        if rng.random() * (len(points) - i) < count - kept:
            points[kept] = points[i]
            kept += 1
    return points[:count].copy(), radius


@njit(cache=True, nogil=True)
def _wrap(x):
    """x modulo 1, in [0, 1): a tiny negative x would round to 1."""
    x -= math.floor(x)
    return x if x < 1 else 0.0


@njit(cache=True, nogil=True)
def _is_free_on_torus(x, y, radius, reach, points, bins):
    side = len(bins)
    column, row = int(x * side), int(y * side)
    for i in range(column - reach, column + reach + 1):
        i += side if i < 0 else -side if i >= side else 0  # much faster than i % side
        for j in range(row - reach, row + reach + 1):
            j += side if j < 0 else -side if j >= side else 0
            other = bins[i, j]
            if other >= 0:
                dx, dy = abs(points[other, 0] - x), abs(points[other, 1] - y)
                dx, dy = min(dx, 1 - dx), min(dy, 1 - dy)
                if dx * dx + dy * dy < radius * radius:
                    return False
    return True


@njit(cache=True, nogil=True)
def _bin(point, radius):
    scale = 1 / radius
    return int((point[0] + 1) * scale), int((point[1] + 1) * scale), int((point[2] + 1) * scale)


@njit(cache=True, nogil=True)
def _bucket(i, j, k, buckets):
    # Primes of Teschner et al. 2003; `buckets` is a power of two.
    return (i * 73856093 ^ j * 19349663 ^ k * 83492791) & (buckets - 1)


@njit(cache=True, nogil=True)
def _insert_on_sphere(point, index, radius, points, latest, before):
    points[index] = point
    i, j, k = _bin(point, radius)
    bucket = _bucket(i, j, k, len(latest))
    before[index] = latest[bucket]
    latest[bucket] = index


@njit(cache=True, nogil=True)
def _is_free_on_sphere(point, radius, points, latest, before):
    column, row, layer = _bin(point, radius)
    x, y, z = point
    for i in range(column - 1, column + 2):
        for j in range(row - 1, row + 2):
            for k in range(layer - 1, layer + 2):
                other = latest[_bucket(i, j, k, len(latest))]
                while other >= 0:
                    dx, dy, dz = points[other, 0] - x, points[other, 1] - y, points[other, 2] - z
                    if dx * dx + dy * dy + dz * dz < radius * radius:
                        return False
                    other = before[other]
    return True


@njit(cache=True, nogil=True)
def _draw_around(centre, radius, rng, out):
    """A point of the sphere with its chord to `centre` in [r, 2r], uniform in area, into `out`."""
    # The cap within a chord c has the area π c², so c² is uniform; on the axis 1 − c² / 2.
    chord2 = radius**2 * (1 + rng.random() * (min(4.0, 4 / radius**2) - 1))
    along = 1 - chord2 / 2
    # A random vector less its part along the centre: a uniform direction across.
    out[0], out[1], out[2] = rng.normal(), rng.normal(), rng.normal()
    out -= np.dot(out, centre) * centre
    out *= math.sqrt(max(0.0, 1 - along * along)) / np.linalg.norm(out)
    out += along * centre
    out /= np.linalg.norm(out)
