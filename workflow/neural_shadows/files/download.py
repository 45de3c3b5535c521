"""Downloads of files with a known SHA-256."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import rmtree
from typing import Any

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import is_full_disk

PART = ".download.part"  # one name: Ctrl-C ends a job at once, and a folder of any name would stay


@contextmanager
def downloaded(
    url: str, sha256: str, folder: Path, cure: str, processor: Any = None, progress: Any = False
) -> Iterator[list[Path]]:
    """Yield a downloaded file, or those unpacked from it; they go after the block.

    An interrupted download starts again with the next attempt, which removes what it left.

    Args:
        folder: for a temporary folder `PART` within it, so that a file can be moved.
        cure: what to do without the download, for the message.
        processor, progress: of `pooch.retrieve`.

    Raises:
        InputError: no connection, another file, or an OSError or ValueError of the block.
        OSError: a full disk.
    """
    import pooch

    part = folder / PART
    rmtree(part, ignore_errors=True)
    part.mkdir(parents=True)
    try:
        files = pooch.retrieve(
            url,
            known_hash=f"sha256:{sha256}",
            path=part,
            fname=Path(url).name,
            processor=processor,
            progressbar=progress,
        )
        yield [Path(file) for file in ([files] if isinstance(files, str) else files)]
    except (OSError, ValueError) as error:  # from requests, or a wrong digest
        if is_full_disk(error):
            raise
        reason = " ".join(str(error).split())[:300]
        raise InputError(f"cannot download {url}: {reason}. {cure}") from error
    finally:
        rmtree(part, ignore_errors=True)
