"""Words of cells: interpolation, and rounding of corners."""

import numpy as np
import pytest
from numba import njit

from neural_shadows.representations.distance_bricks.cell_words import (
    CORNERS,
    PART,
    WORDS,
    fill_words,
    positive_at,
)

RNG = np.random.default_rng(3)


@njit
def signs(words, points):
    """Whether each word (n,) is positive at each of its places (n, k, 3) in 2^−PART cells."""
    result = np.empty(points.shape[:2], np.bool_)
    for n in range(len(words)):
        for k in range(points.shape[1]):
            x, y, z = points[n, k]
            result[n, k] = positive_at(words[n], words.itemsize == 8, x, y, z)
    return result


def between(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Interpolated values (n, k) of corners (n, 8) at places (n, k, 3) in cells."""
    shares = np.abs(1 - CORNERS - points[:, :, None]).prod(axis=3)
    return np.einsum("nkc,nc->nk", shares, corners)


def words_of(corners: np.ndarray, bits: int) -> np.ndarray:
    """Of cells' corners (n, 8), each the first cell of a brick of its own."""
    bricks = np.zeros((len(corners), 5, 5, 5), np.float32)
    bricks[:, *CORNERS.T] = corners
    words = np.empty(len(corners), WORDS[bits])
    crossed = np.ones(len(corners), np.uint64)
    fill_words(bricks.reshape(-1, 125), np.float32(0), crossed, words)
    return words


def values_of(words: np.ndarray) -> np.ndarray:
    bits = words.dtype.type(words.itemsize)
    levels = words[:, None] >> np.arange(8, dtype=words.dtype) * bits & words.dtype.type(
        2**bits - 1
    )
    return levels.astype(float) - 2.0 ** (bits - 1.0) + 0.5


@pytest.mark.parametrize("bits", [4, 8])
def test_the_sign_between_corners_is_exact(bits):
    words = RNG.integers(0, 1 << 8 * bits, 2000, dtype=WORDS[bits])
    points = RNG.integers(0, 1 << PART, (2000, 20, 3))
    if bits == 8:
        points[..., 2] &= 255 << PART - 8  # its first axis is looked up in so many bits
    points[:, 0] = 0
    expected = between(values_of(words), points / 2**PART)
    clear = np.abs(expected) > 1e-9  # exactly 0 is not positive, and float64 may not be exact
    assert clear.mean() > 0.999
    assert np.array_equal(signs(words, points)[clear], (expected > 0)[clear])


def test_values_that_are_levels_keep_their_ratios():
    levels = RNG.integers(-7, 7, (500, 8)) + 0.5
    levels[:, 0] = 7.5 * RNG.choice([-1, 1], 500)
    result = values_of(words_of(levels.astype(np.float32) * 3e-3, 4))
    assert np.allclose(result, levels)


def test_planes_move_little():
    """How far a plane through a cell is moved by rounding, along its normal, in cells."""
    normals = RNG.normal(size=(3000, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    through = RNG.uniform(0.1, 0.9, (3000, 1, 3))
    corners = ((CORNERS - through) * normals[:, None]).sum(axis=2)
    # Places on the plane, inside the cell.
    points = RNG.uniform(0, 1, (3000, 30, 3))
    points -= ((points - through) * normals[:, None]).sum(axis=2, keepdims=True) * normals[:, None]
    inside = ((points > 0) & (points < 1)).all(axis=2)

    def moved(result: np.ndarray) -> float:
        """Root of the mean square; the gradient's length is that of the plane fitted to corners."""
        slopes = np.linalg.norm(
            (result - result.mean(axis=1, keepdims=True)) @ (CORNERS - 0.5) / 2, axis=1
        )
        return np.sqrt(np.square((between(result, points) / slopes[:, None])[inside]).mean())

    nearest = np.floor(corners * 8 / np.abs(corners).max(axis=1, keepdims=True)).clip(-8, 7) + 0.5
    assert moved(corners) < 1e-6
    four, eight = (moved(values_of(words_of(corners.astype(np.float32), bits))) for bits in (4, 8))
    assert four < 0.6 * moved(nearest) < 0.012
    assert eight < 0.0015
