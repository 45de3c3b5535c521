"""Memory-mapped `.npy` arrays, possibly larger than memory."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file


@contextmanager
def new_array(path: Path, shape: tuple[int, ...], dtype: type = np.float32) -> Iterator[np.ndarray]:
    """New array to be filled; written whole or not at all."""
    with whole_file(path) as part:
        array = np.lib.format.open_memmap(part, mode="w+", dtype=dtype, shape=shape)
        if hasattr(os, "posix_fallocate"):
            # A full disk raises an error here; while writing a page it would kill the process.
            with part.open("rb+") as file:
                os.posix_fallocate(file.fileno(), 0, part.stat().st_size)
        yield array
        array.flush()


def open_array(
    path: Path,
    shape: tuple[int | None, ...],
    dtype: type = np.float32,
    cure: str = "Delete it and run again",
) -> np.ndarray:
    """Open an array for reading; `None` in `shape` is any length.

    Args:
        cure: what to do about a file that cannot be used.

    Raises:
        InputError: the file is missing, damaged, or of another type or shape.
    """
    try:
        array = np.lib.format.open_memmap(path, mode="r")  # never reads pickles
    except (OSError, ValueError) as error:
        problem = "missing" if isinstance(error, FileNotFoundError) else f"damaged ({error})"
        raise InputError(f"{path}: {problem}. {cure}") from error
    fits = len(array.shape) == len(shape) and all(
        expected in (None, length) for length, expected in zip(array.shape, shape, strict=True)
    )
    if array.dtype != dtype or not fits:
        raise InputError(
            f"{path}: is {array.dtype} {array.shape}, not {np.dtype(dtype)} {shape} "
            f"(None: any length). {cure}"
        )
    return np.asarray(array)  # a plain view of the mapping: numba takes no memmap
