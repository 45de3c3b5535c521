"""Files are whole or not there, whatever goes wrong while they are written."""

import hashlib
import os
import subprocess
import sys

import numpy as np
import pytest

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import (
    read_json,
    sha256_of,
    whole_file,
    write_array,
    write_json,
    write_text,
)


def test_a_file_appears_when_its_block_ends(tmp_path):
    path = tmp_path / "new" / "folder" / "mesh.ply"
    with whole_file(path) as part:
        assert part.parent == path.parent  # a rename within one file system
        assert part.name.startswith(".") and part.suffix == ".ply"
        part.write_bytes(b"ply")
        assert not path.exists()
    assert path.read_bytes() == b"ply"
    assert os.listdir(path.parent) == ["mesh.ply"]


@pytest.mark.parametrize("error", [ValueError, OSError, KeyboardInterrupt])
def test_an_error_leaves_the_old_file(tmp_path, error):
    path = tmp_path / "a.txt"
    write_text(path, "old")
    with pytest.raises(error), whole_file(path) as part:
        part.write_text("half of the new")
        raise error
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


KILLED = """
import os, sys
from neural_shadows.files.whole_files import whole_file

with whole_file(sys.argv[1]) as part:
    part.write_bytes(b"half of the")
    os._exit(9)
"""

# A limit on a file's size gives the same short writes as a full disk.
FULL_DISK = """
import resource, signal, sys
import numpy as np
from neural_shadows.files.whole_files import write_array, write_text

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
for write, content in ((write_text, "new" * 100_000), (write_array, np.zeros(100_000))):
    try:
        write(sys.argv[1], content)
    except OSError as error:
        print(error)
"""


def run(program, path):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", program, path]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)


def test_what_a_killed_process_left_goes_with_the_next_write(tmp_path):
    path = tmp_path / "rays.npy"
    assert run(KILLED, path).returncode == 9
    assert len(os.listdir(tmp_path)) == 1 and not path.exists()
    write_array(path, np.arange(3, dtype=np.float32))
    assert os.listdir(tmp_path) == ["rays.npy"]
    assert np.load(path).tolist() == [0, 1, 2]


def test_a_full_disk_leaves_the_old_file_and_is_named(tmp_path):
    path = tmp_path / "a.npy"
    write_text(path, "old")
    lines = run(FULL_DISK, path).stdout.splitlines()
    assert lines == [f"[Errno 27] File too large: '{path}'"] * 2
    assert path.read_text() == "old" and os.listdir(tmp_path) == ["a.npy"]


def test_json_is_utf8_to_be_read_and_compared(tmp_path):
    value = {"seed": 2026, "loss": 1 / 3, "names": ["wyrm", "²"], "none": None}
    write_json(tmp_path / "a.json", value)
    assert read_json(tmp_path / "a.json") == value
    text = (tmp_path / "a.json").read_bytes().decode("utf-8")
    assert text.endswith("}\n") and len(text.splitlines()) > 4


@pytest.mark.parametrize(
    ("content", "reason"), [(None, "no such file"), (b'{"a": 1', "damaged"), (b"\xff", "damaged")]
)
def test_json_that_cannot_be_read_is_named(tmp_path, content, reason):
    path = tmp_path / "a.json"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=f"a.json: {reason}"):
        read_json(path)


def test_sha256(tmp_path):
    (tmp_path / "a").write_bytes(b"abc" * 1_000_000)
    assert sha256_of(tmp_path / "a") == hashlib.sha256(b"abc" * 1_000_000).hexdigest()
