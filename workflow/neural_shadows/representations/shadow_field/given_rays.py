"""Checked points and directions of a user, in radii of a field's sphere."""

import math
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
    length = math.hypot(*vector)  # no squares, which overflow
    if length == 0:
        raise InputError(
            f"{name}: {vector.tolist()}: has no direction. Give a vector to the light."
        )
    return vector / length


def units_of(rows: np.ndarray, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors (n, 3) float32 along rows (n, 3), and lengths (n,) float64.

    Raises:
        InputError: a row is zero or not finite.
    """
    x, y, z = rows.T
    lengths = np.hypot(np.hypot(x, y), z)  # no squares, which overflow
    valid = (lengths > 0) & (lengths < np.inf)
    if not valid.all():
        raise InputError(
            f"{name}: row {int(np.argmin(valid))} (counted from 0): has no direction. Give finite "
            "vectors, not zero."
        )
    return (rows / lengths[:, None]).astype(np.float32), lengths.astype(np.float64)


def in_radii(rows: np.ndarray, name: str, centre: np.ndarray, radius: float) -> np.ndarray:
    """Map rows (n, 3) to (x − centre) / radius, float32; `centre` is (3,) float64.

    Raises:
        InputError: a row is not finite in float32.
    """
    result = np.empty(rows.shape, np.float32)
    if not _map(rows, centre, 1 / radius, result):
        invalid = int(np.argmin(np.isfinite(result).all(axis=1)))
        raise InputError(
            f"{name}: row {invalid} (counted from 0) is {rows[invalid].tolist()}: not finite in "
            "float32. Leave such rows out."
        )
    return result


def all_alike(rows: np.ndarray) -> bool:
    """Test for equal rows (n, 3), at least one; NaN equals nothing."""
    return len(rows) > 0 and _alike(rows)


@njit(cache=True, nogil=True)
def _map(rows, centre, scale, result):
    """Fill in `result`; return whether all of it is finite."""
    x, y, z = centre
    finite = True
    for n in range(len(rows)):
        a = np.float32((rows[n, 0] - x) * scale)
        b = np.float32((rows[n, 1] - y) * scale)
        c = np.float32((rows[n, 2] - z) * scale)
        result[n, 0], result[n, 1], result[n, 2] = a, b, c
        finite &= (abs(a) < np.inf) & (abs(b) < np.inf) & (abs(c) < np.inf)
    return finite


@njit(cache=True, nogil=True)
def _alike(rows):
    x, y, z = rows[0]
    alike = True
    for n in range(len(rows)):
        alike &= (rows[n, 0] == x) & (rows[n, 1] == y) & (rows[n, 2] == z)
    return alike
