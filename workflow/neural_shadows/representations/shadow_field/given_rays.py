"""Checked points and directions of a user, in radii of a field's sphere."""

from typing import Any

import numpy as np
from numba import njit

from neural_shadows.errors import InputError


def rows_of(given: Any, name: str, width: int = 3) -> np.ndarray:
    """Rows (n, width) of floats, as given or converted.

    Raises:
        InputError: another shape, or no numbers.
    """
    try:
        rows = np.asarray(given)
        rows = rows if rows.dtype in (np.float32, np.float64) else rows.astype(np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: {type(given).__name__}: no numbers. Give floats.") from None
    if rows.ndim != 2 or rows.shape[1] != width:
        raise InputError(f"{name}: shape {rows.shape}: not (n, {width}). Give one row for each.")
    return np.ascontiguousarray(rows)


def vector_of(given: Any, name: str) -> np.ndarray:
    """One finite vector, (3,) float64.

    Raises:
        InputError: another shape, no numbers, or not finite.
    """
    (vector,) = rows_of([given], name).astype(np.float64)
    if not np.isfinite(vector).all():
        raise InputError(f"{name}: {vector.tolist()}: not finite. Give three finite numbers.")
    return vector


def direction_of(given: Any, name: str) -> np.ndarray:
    """One unit vector, (3,) float64; see `vector_of`. A zero vector is refused."""
    vector = vector_of(given, name)
    length = np.linalg.norm(vector)
    if length == 0:
        raise InputError(
            f"{name}: {vector.tolist()}: has no direction. Give a vector to the light."
        )
    return vector / length


def vectors_of(given: Any, name: str) -> np.ndarray:
    """Finite vectors (n, 3) float32; see `rows_of`.

    Raises:
        InputError: as `rows_of`; one is zero or not finite.
    """
    vectors = in_radii(rows_of(given, name), name, np.zeros(3), 1.0)
    if not (vectors.any(axis=1)).all():
        row = int(np.argmin(vectors.any(axis=1)))
        raise InputError(f"{name}: row {row} (counted from 0): has no direction. Give vectors.")
    return vectors


def in_radii(rows: np.ndarray, name: str, centre: np.ndarray, radius: float) -> np.ndarray:
    """Map rows (n, 3) to (x − centre) / radius, float32; `centre` is (3,) float64.

    Raises:
        InputError: a row is not finite.
    """
    result = np.empty(rows.shape, np.float32)
    invalid = _map(rows, centre, 1 / radius, result)
    if invalid >= 0:
        raise InputError(
            f"{name}: row {invalid} (counted from 0) is {rows[invalid].tolist()}: not finite. Leave "
            "such rows out."
        )
    return result


@njit(cache=True, nogil=True)
def _map(rows, centre, scale, result):
    """Fill in `result`; return the first row that is not finite, or −1."""
    x, y, z = centre
    for n in range(len(rows)):
        result[n, 0] = (rows[n, 0] - x) * scale
        result[n, 1] = (rows[n, 1] - y) * scale
        result[n, 2] = (rows[n, 2] - z) * scale
        if not abs(rows[n, 0]) + abs(rows[n, 1]) + abs(rows[n, 2]) < np.inf:
            return n
    return -1
