"""Arrays on disk that may be larger than memory: `.npy` files, memory-mapped."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file


@contextmanager
def new_array(path: Path, shape: tuple[int, ...], dtype: type = np.float32) -> Iterator[np.ndarray]:
    """A new file to be filled; whole or not at all."""
    with whole_file(path) as part:
        array = np.lib.format.open_memmap(part, mode="w+", dtype=dtype, shape=shape)
        if hasattr(os, "posix_fallocate"):
            # A full disk is an error here; found when a page is written, it kills the process.
            with part.open("rb+") as file:
                os.posix_fallocate(file.fileno(), 0, part.stat().st_size)
        yield array
        array.flush()


def open_array(path: Path, shape: tuple[int | None, ...], dtype: type = np.float32) -> np.ndarray:
    """A file to be read; `None` in `shape` is any length.

    Raises:
        InputError: it is missing, damaged, or of another type or shape.
    """
    try:
        array = np.lib.format.open_memmap(path, mode="r")  # which refuses pickles
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: damaged ({error}); delete it and run again") from error
    fits = len(array.shape) == len(shape) and all(
        wanted in (None, length) for length, wanted in zip(array.shape, shape, strict=True)
    )
    if array.dtype != dtype or not fits:
        raise InputError(
            f"{path}: holds {array.dtype} {array.shape} where {np.dtype(dtype)} {shape} belongs "
            "(None: any length); delete it and run again"
        )
    return np.asarray(array)  # a plain view of the mapping: numba takes no memmap
