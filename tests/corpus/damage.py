"""What can lie in the place of a file, and whole files with something changed."""

import io
import pickle
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import torch
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
    saved, zipped = io.BytesIO(), io.BytesIO()
    torch.save({"0.weight": Payload()}, saved)
    with zipfile.ZipFile(zipped, "w") as archive:
        archive.writestr("../escaped", b"bad")
    return {
        "nothing": b"",
        "a line end": b"\n",
        "a pickle": pickle.dumps(Payload()),
        "a PyTorch file with a pickle": saved.getvalue(),
        "an archive": zipped.getvalue(),
        "a picture": b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 4,
        "a page": b"<!DOCTYPE html>\n<html><body>404 Not Found</body></html>\n",
        "a number": b"3",
        "nested": b"[" * 2_000,
        "zero bytes": bytes(5000),
    }


# What a damaged disk or an editor puts where a number was.
NUMBERS = [
    *("nan", "inf", "-inf", "-0", "0", "-1", "1e999", "1e-320", "0.5", "1e308", "x", ""),
    *(str(2**n + d) for n in (7, 8, 15, 16, 31, 32, 63, 64) for d in (-1, 0)),
]
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


@st.composite
def changed_bytes(draw: st.DrawFn, whole: bytes) -> bytes:
    """One to three places cut, repeated, overwritten or filled; or the file cut off."""
    data = bytearray(whole)
    for _ in range(draw(st.integers(1, 3))):
        # Headers decide most: half of the places are in the first kilobyte.
        last = max(0, len(data) - 1)
        at = draw(st.integers(0, min(last, 1023)) | st.integers(0, last))
        length = draw(st.integers(1, 64))
        match draw(st.sampled_from(["overwrite", "cut", "repeat", "insert", "end"])):
            case "overwrite":
                new = draw(st.binary(min_size=1, max_size=8))
                data[at : at + len(new)] = new
            case "cut":
                del data[at : at + length]
            case "repeat":
                data[at:at] = data[at : at + length] * draw(st.integers(1, 3))
            case "insert":
                data[at:at] = draw(st.binary(min_size=1, max_size=32))
            case "end":
                del data[at:]
    return bytes(data)


@st.composite
def changed_numbers(draw: st.DrawFn, whole: bytes) -> bytes:
    """One to four of a text's numbers replaced."""
    found = st.sampled_from(list(NUMBER.finditer(whole)))
    chosen = draw(st.lists(found, min_size=1, max_size=4, unique_by=lambda match: match.start()))
    for match in sorted(chosen, key=lambda match: -match.start()):
        new = draw(st.sampled_from(NUMBERS)).encode()
        whole = whole[: match.start()] + new + whole[match.end() :]
    return whole
