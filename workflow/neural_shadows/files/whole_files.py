"""Files that are written whole or not at all, and their digests."""

import glob
import hashlib
import io
import json
import os
import socket
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.files.broken import reading

# Whoever writes a temporary file is in its name, and not a lock on it: NFS keeps a lock to its
# host, and SMB lets nobody but the lock's own descriptor write.
_HOST = socket.gethostname()

# After which a temporary file of another host, whose processes are not seen, is left behind. None
# takes a day to write.
_ABANDONED_S = 86_400


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
    for part in path.parent.glob(f"{glob.escape(start)}*{glob.escape(suffix)}"):
        if _is_left(part.name.removeprefix(start).removesuffix(suffix), part):
            part.unlink(missing_ok=True)
    writer = f"{start}{_HOST}-{os.getpid()}-"
    handle, name = tempfile.mkstemp(prefix=writer, suffix=suffix, dir=path.parent)
    os.close(handle)
    part = Path(name)
    try:
        yield part
        # On disk before it gets its name: after a power cut, a file that is there is whole.
        with part.open("rb") as file:
            os.fsync(file.fileno())
        with suppress(OSError):  # where modes are the mount's
            part.chmod(0o644)  # mkstemp gives 0600, which hides results from a shared group
        part.replace(path)
    except OSError as error:
        if error.errno and error.filename is None:  # of a write: it knows no name
            error.filename = str(path)
        raise
    finally:
        part.unlink(missing_ok=True)


def _is_left(writer: str, part: Path) -> bool:
    """Whether the process `writer` that began a temporary file is gone."""
    host, pid, _ = writer.rsplit("-", 2) if writer.count("-") >= 2 else ("", "", "")
    try:
        if host == _HOST and pid.isdecimal():
            os.kill(int(pid), 0)  # asks only whether it is there
            return False
        return time.time() - part.stat().st_mtime > _ABANDONED_S
    except ProcessLookupError:
        return True
    except OSError:  # another user's process; or the file has gone
        return False


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
        InputError: the file is missing or cannot be read; or it is no JSON, and moved aside.
    """
    with reading(path, "JSON file", RecursionError):  # nested too deep
        return json.loads(Path(path).read_text(encoding="utf-8"))


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
