"""Files that are written whole or not at all, and their digests."""

import fcntl
import glob
import hashlib
import io
import json
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.errors import InputError


@contextmanager
def whole_file(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`; rename it to `path` when the block ends.

    If the block raises, the temporary file is removed and an older `path` is left as it
    was. What killed processes left of the same file is removed. The suffix of `path` is kept,
    since many writers choose their format by it.

    Raises:
        OSError: the folder cannot be written, or the disk is full.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    start, suffix = f".{path.name}.", f".part{path.suffix}"
    for left in path.parent.glob(f"{glob.escape(start)}*{glob.escape(suffix)}"):
        _remove_if_left(left)
    handle, name = tempfile.mkstemp(prefix=start, suffix=suffix, dir=path.parent)
    part = Path(name)
    try:
        with suppress(OSError):  # some cluster file systems have no locks
            fcntl.flock(handle, fcntl.LOCK_EX)  # ends with the process, however that ends
        yield part
        # On disk before it gets its name: after a power cut, a file that is there is whole.
        with part.open("rb") as file:
            os.fsync(file.fileno())
        part.chmod(0o644)  # mkstemp gives 0600, which hides results from a shared group
        part.replace(path)
    except OSError as error:
        if error.errno and error.filename is None:  # of a write: it knows no name
            error.filename = str(path)
        raise
    finally:
        part.unlink(missing_ok=True)
        os.close(handle)


def _remove_if_left(part: Path) -> None:
    """Remove a temporary file, unless a process is writing it or that cannot be told."""
    with suppress(OSError), part.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        part.unlink()


def write_text(path: str | Path, text: str) -> None:
    """Write `text` as UTF-8, whole or not at all."""
    with whole_file(path) as part:
        part.write_text(text, encoding="utf-8")


def write_json(path: str | Path, value: Any) -> None:
    """Write `value` as indented JSON, whole or not at all."""
    write_text(path, json.dumps(value, indent=2) + "\n")


def read_json(path: str | Path) -> Any:
    """Read a JSON file.

    Raises:
        InputError: the file is missing, or it is no JSON.
    """
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise InputError(f"{path}: no such file; run the stage that makes it") from error
    except (ValueError, RecursionError, OSError) as error:  # nested too deep; or a folder
        raise InputError(f"{path}: not a JSON file ({error}); delete it and run again") from error


def write_array(path: str | Path, array: np.ndarray) -> None:
    """Write one array as `.npy` (no pickle), whole or not at all."""
    content = io.BytesIO()
    np.save(content, array, allow_pickle=False)
    with whole_file(path) as part:
        # Not by numpy's own writer, whose error on a full disk does not say so.
        part.write_bytes(content.getbuffer())


def sha256_of(path: str | Path) -> str:
    """Hexadecimal SHA-256 of a file's content."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
