"""Samples of lights in rings: a sphere seen as a disc, and polygons.

One set of samples serves lights of several radii about the same centre: a light of the k-th radius
consists of the first k rings, each weighted by its area (Datta et al. 2022, supplement 5).
"""

import numpy as np
from numba import njit

from neural_shadows.rendering.perpendicular import perpendicular

# The generalised golden ratio's plane sequence (Roberts 2018): any run of it is evenly spread.
_GOLDEN = (0.7548776662466927, 0.5698402909980532)
_SECTION = (5**0.5 - 1) / 2  # of a turn, between neighbours of a spiral (Vogel 1979)


def sequence_run(first: int, count: int) -> np.ndarray:
    """Samples of a sequence of any length: shares of a ring's area, and of a turn, (2, count) float64.

    Args:
        first: number of samples of the sequence drawn before.
    """
    numbers = first + np.arange(count) + 0.5
    return np.stack([numbers * _GOLDEN[0] % 1, numbers * _GOLDEN[1] % 1])


def spiral(count: int) -> np.ndarray:
    """A whole set of samples, one in each of as many rings of equal area: see `sequence_run`.

    It is shifted by `spiral_shifts`. Of 3 to 12 samples the shares of half-planes
    that cover the light are off by a seventh to a third less than of `sequence_run` (squared), of two more.
    """
    numbers = np.arange(count)
    return np.stack([numbers / count, numbers * _SECTION % 1])


@njit(cache=True, nogil=True)
def spiral_shifts(shifts, frame, count):
    """Shifts of a `spiral` of `count` samples by those of a sequence, elsewhere in each frame.

    Args:
        shifts: (n, rings, 2) in [0, 1).
    """
    # In this order means of eight frames of 3 to 12 rays err by 10 to 55 % less than in the other (half-planes).
    turned = np.empty_like(shifts)
    for i in range(len(shifts)):
        for ring in range(shifts.shape[1]):
            turned[i, ring, 0] = (shifts[i, ring, 0] + frame * _GOLDEN[1]) % 1
            turned[i, ring, 1] = (shifts[i, ring, 1] + frame * _GOLDEN[0]) % 1 / count
    return turned


def ring_shares(radii: np.ndarray) -> np.ndarray:
    """Area shares of rings of each light: (K, K) float32, rows by light.

    Args:
        radii: (K,), growing, above 0.
    """
    squares = np.square(radii, dtype=np.float64)
    areas = np.diff(squares, prepend=0.0)
    shares = np.tril(np.broadcast_to(areas, (len(radii), len(radii)))) / squares[:, None]
    return shares.astype(np.float32)


@njit(cache=True, nogil=True)
def _hashed(value):
    """Hash an integer to [0, 1) (Wellons 2018, lowbias32)."""
    x = np.uint32(value)
    x ^= x >> np.uint32(16)
    x = np.uint32(x * np.uint32(0x7FEB352D))
    x ^= x >> np.uint32(15)
    x = np.uint32(x * np.uint32(0x846CA68B))
    x ^= x >> np.uint32(16)
    return x / 4294967296.0


@njit(cache=True, nogil=True)
def random_shifts(keys, rings):
    """Shifts of `ring_vectors` by integer keys (n,), independent of each other: (n, rings, 2).

    Up to 16 rings, and keys below 2²⁷."""
    shifts = np.empty((len(keys), rings, 2))
    for i in range(len(keys)):
        for k in range(2 * rings):
            shifts[i, k // 2, k % 2] = _hashed(keys[i] * 32 + k)
    return shifts


@njit(cache=True, nogil=True)
def even_shifts(pixels, width):
    """Shifts of a ring by pixel, row · width + column, evenly spread over neighbours: (n, 1, 2).

    Of a lattice (Roberts 2018) and the same turned by a right angle, as filters of few rays are fed. Of
    one ray the FFX- and SVGF-like filters' squared errors are 9 to 29 % less than of independent shifts,
    of two 2 to 7 % (three rooms, lights of 6 and 25 cm).
    """
    shifts = np.empty((len(pixels), 1, 2))
    for i in range(len(pixels)):
        row, column = pixels[i] // width, pixels[i] % width
        shifts[i, 0, 0] = (_GOLDEN[0] * column + _GOLDEN[1] * row) % 1
        shifts[i, 0, 1] = (_GOLDEN[1] * column - _GOLDEN[0] * row) % 1
    return shifts


@njit(cache=True, nogil=True)
def ring_vectors(points, shifts, samples, centre, radii, counts, vectors):
    """Fill `vectors` (n, Σ counts, 3) from points to samples, by ring.

    Args:
        points: (n, 3) float32.
        shifts: (n, rings, 2) in [0, 1), by which a point's samples are turned and shifted in each ring.
        samples: (2, largest count) of `sequence_run` or `spiral`, for all points and rings.
        centre: (3,) float64 of the light; radii: (K,) float64 of the rings' outer edges.
        counts: (K,) int64, samples of each ring.
    """
    # Angles are looked up and turned: a sine of each sample took half of the time.
    shares, angles = samples[0], 2 * np.pi * samples[1]
    cosines, sines = np.cos(angles), np.sin(angles)
    for i in range(len(points)):
        x, y, z = (
            centre[0] - points[i, 0],
            centre[1] - points[i, 1],
            centre[2] - points[i, 2],
        )
        length = np.sqrt(x * x + y * y + z * z)
        nx, ny, nz = x / length, y / length, z / length
        (ux, uy, uz), (vx, vy, vz) = perpendicular(nx, ny, nz)
        index, inner = 0, 0.0
        for ring in range(len(radii)):
            outer = radii[ring] * radii[ring]
            if counts[ring] == 0:
                inner = outer
                continue
            turn, shift = 2 * np.pi * shifts[i, ring, 0], shifts[i, ring, 1]
            c, s = np.cos(turn), np.sin(turn)
            for k in range(counts[ring]):
                share = shares[k] + shift
                share -= share >= 1
                radius = np.sqrt(inner + (outer - inner) * share)
                p = radius * (c * cosines[k] - s * sines[k])
                q = radius * (c * sines[k] + s * cosines[k])
                vectors[i, index, 0] = x + p * ux + q * vx
                vectors[i, index, 1] = y + p * uy + q * vy
                vectors[i, index, 2] = z + p * uz + q * vz
                index += 1
            inner = outer


@njit(cache=True, nogil=True)
def polygon_vectors(points, shifts, samples, centre, corners, radii, counts, vectors):
    """Fill `vectors` (n, Σ counts, 3) from points to samples of a polygon, by ring.

    A ring lies between copies of the polygon, scaled about the centre.

    Args:
        points, shifts, samples, centre, radii, counts: see `ring_vectors`.
        corners: (S, 3) float64, about the centre in turn, at radius 1; the triangles of the centre
            and two of them have equal areas, as those of a rectangle or a regular polygon.
    """
    shares, turns = samples
    for i in range(len(points)):
        index, inner = 0, 0.0
        for ring in range(len(radii)):
            outer = radii[ring] * radii[ring]
            turn, shift = shifts[i, ring]
            for k in range(counts[ring]):
                share = shares[k] + shift
                share -= share >= 1
                side = (turns[k] + turn) % 1 * len(corners)
                begin = min(int(side), len(corners) - 1)
                along, end = side - begin, (begin + 1) % len(corners)
                scale = np.sqrt(inner + (outer - inner) * share)
                for axis in range(3):
                    rim = (1 - along) * corners[begin, axis] + along * corners[end, axis]
                    vectors[i, index, axis] = centre[axis] - points[i, axis] + scale * rim
                index += 1
            inner = outer
