"""Downloads: what goes wrong is said of what it is."""

import errno
import hashlib
import os

import pytest
from served import served

from neural_shadows.errors import InputError
from neural_shadows.files.download import PART, downloaded

CONTENT = b"weights"
SHA256 = hashlib.sha256(CONTENT).hexdigest()


@pytest.mark.parametrize(
    ("code", "kind", "words"),
    [
        (errno.ENOSPC, OSError, "No space left on device"),  # the stage says what to do
        (errno.ECONNRESET, InputError, "cannot download .*Connection reset.* Try again"),
    ],
)
def test_a_full_disk_is_no_failed_download(tmp_path, code, kind, words):
    """Nor does anything stay, not even of a job that Ctrl-C has ended before."""
    (tmp_path / "file").write_bytes(CONTENT)
    (tmp_path / "new" / PART).mkdir(parents=True)
    (tmp_path / "new" / PART / "half").write_bytes(CONTENT[:3])
    with (
        served(tmp_path) as address,
        pytest.raises(kind, match=words),
        downloaded(f"{address}file", SHA256, tmp_path / "new", "Try again") as (file,),
    ):
        assert file.read_bytes() == CONTENT
        raise OSError(code, os.strerror(code))
    assert not list((tmp_path / "new").iterdir())
