"""Atomic writing of files, and their digests."""

import errno
import hashlib
import io
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.errors import InputError


@contextmanager
def whole_file(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path, renamed to `path` after the block.

    If the block raises, the temporary file is removed and an older `path` stays unchanged. The
    temporary name is fixed, since each file has one writer, a job of Snakemake: leftovers of a killed
    process are overwritten. It has the suffix of `path`, by which many writers choose their format.

    Raises:
        OSError: the folder cannot be written, or the disk is full.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.part{path.suffix}")
    try:
        yield part
        os.replace(part, path)
    except OSError as error:
        if error.errno and error.filename is None:  # a full disk: the error has no name
            error.filename = str(path)
        raise
    finally:
        part.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write `text` as UTF-8, whole or not at all."""
    with whole_file(path) as part:
        part.write_text(text, encoding="utf-8")


def write_json(path: str | Path, value: Any) -> None:
    """Write `value` as indented JSON, whole or not at all."""
    write_text(path, json.dumps(value, indent=2) + "\n")


def read_json(path: str | Path) -> Any:
    """Read a JSON file of an earlier job.

    Raises:
        InputError: the file is missing, cannot be read or is not whole.
    """
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from error
    except ValueError as error:
        raise InputError(f"{path}: damaged ({error}). Delete it and run again") from error


def write_array(path: str | Path, array: np.ndarray) -> None:
    """Write one array as `.npy` (no pickle), whole or not at all."""
    content = io.BytesIO()
    np.save(content, array, allow_pickle=False)
    with whole_file(path) as part:
        # numpy's own writer has an unclear error on a full disk.
        part.write_bytes(content.getbuffer())


def sha256_of(path: str | Path) -> str:
    """Hexadecimal SHA-256 of a file."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def is_full_disk(error: BaseException) -> bool:
    """Whether a file could not be written for lack of room, or of a user's quota."""
    return isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT)
