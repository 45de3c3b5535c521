"""Compressed files, which may unpack to more than memory holds."""

import gzip
import zlib
from pathlib import Path

# Meshes shrink to a fifth, and drawn by rulers to a thirtieth; what shrinks to less than a
# hundredth is repetition. Gzip itself reaches a thousandth.
MAX_RATIO = 100
# Of any file this much may be repetition.
HARMLESS_BYTES = 2**24

_BLOCK = 2**20


def unpack(path: Path, max_bytes: int) -> bytes:
    """Content of a gzip file, which is unpacked no further than it may be.

    Raises:
        ValueError: it is damaged or cut short, has more than `max_bytes`, or more than
            `MAX_RATIO` times its size on disk; the reason alone, to follow the file's name.
        OSError: it cannot be read.
    """
    most = min(max_bytes, max(HARMLESS_BYTES, MAX_RATIO * path.stat().st_size))
    blocks, size = [], 0
    try:
        with gzip.open(path, "rb") as file:
            while block := file.read(_BLOCK):
                blocks.append(block)
                size += len(block)
                if size > most:
                    raise ValueError(f"unpacks to more than {most:,} bytes")
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise ValueError(f"the compressed data is damaged or truncated ({error})") from error
    return b"".join(blocks)
