"""Files are whole or not there, whatever goes wrong while they are written."""

import os
import subprocess
import sys

import numpy as np
import pytest

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import (
    read_json,
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


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
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


def test_json(tmp_path):
    path, value = tmp_path / "a.json", {"seed": 2026, "loss": 1 / 3, "names": ["wyrm", "²"]}
    with pytest.raises(InputError, match="a.json: cannot be read"):
        read_json(path)
    write_json(path, value)
    assert read_json(path) == value
    path.write_bytes(path.read_bytes()[:9])
    with pytest.raises(InputError, match="a.json: damaged"):
        read_json(path)
