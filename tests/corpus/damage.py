"""What can lie in the place of a file, and whole files with something changed."""

import io
import pickle
from collections.abc import Callable
from pathlib import Path

import torch
from hypothesis import given
from hypothesis import strategies as st

from neural_shadows.errors import InputError


def reads(read: Callable[[Path], object], path: Path) -> bool:
    """Whether a file is read; if not, it must be said in one line that names the file."""
    try:
        read(path)
    except InputError as error:
        message = str(error)
        assert "\n" not in message and path.name in message and len(message) < 900, message
        return False
    return True


class Payload:
    """What makes the file `pickle_ran` where it is unpickled."""

    def __reduce__(self):
        return Path.touch, (Path("pickle_ran"),)


def strangers() -> dict[str, bytes]:
    """Files of other kinds, some of which run code where they are unpickled."""
    saved = io.BytesIO()
    torch.save({"0.weight": Payload()}, saved)
    return {
        "nothing": b"",
        "a pickle": pickle.dumps(Payload()),
        "a PyTorch file with a pickle": saved.getvalue(),
        "a picture": b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 4,
        "a page": b"<!DOCTYPE html>\n<html><body>404 Not Found</body></html>\n",
        "nested": b"[" * 2_000,
        "zero bytes": bytes(5000),
    }


@st.composite
def changed_bytes(draw: st.DrawFn, whole: bytes) -> bytes:
    """One to three places cut, overwritten or filled; perhaps the file cut off."""
    data = bytearray(whole)
    for _ in range(draw(st.integers(1, 3))):
        # Headers decide most: half of the places are in the first kilobyte.
        at = draw(st.integers(0, 1023) | st.integers(0, len(whole)))
        data[at : at + draw(st.integers(0, 64))] = draw(st.binary(max_size=32))
    return bytes(data[: draw(st.just(len(data)) | st.integers(0, len(data)))])


def check_reader(read: Callable[[Path], object], path: Path, whole: bytes) -> None:
    """Check that a reader reads a file, refuses strangers in its place, and survives damage."""

    def reads_content(content):
        path.write_bytes(content)
        return reads(read, path)

    assert reads_content(whole)
    for name, content in strangers().items():
        assert not reads_content(content), name

    @given(changed_bytes(whole))
    def check(content):
        reads_content(content)

    check()
    assert {one.name for one in path.parent.iterdir()} <= {path.name, "out"}
