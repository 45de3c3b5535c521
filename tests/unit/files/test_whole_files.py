"""Files are whole or not there, whatever goes wrong while they are written."""

import os
import subprocess
import sys

import pytest

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import read_json, whole_file, write_json, write_text


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
def test_an_error_leaves_the_old_file(tmp_path, error):
    path = tmp_path / "new" / "a.txt"
    write_text(path, "old")
    with pytest.raises(error), whole_file(path) as part:
        part.write_text("half of the new")
        raise error
    assert path.read_text() == "old"
    assert os.listdir(path.parent) == ["a.txt"]


# A limit on a file's size gives the same short writes as a full disk; then the process is killed.
KILLED_ON_A_FULL_DISK = """
import os, resource, signal, sys
from neural_shadows.files.whole_files import whole_file, write_array, write_text

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
for write, content in ((write_text, "new" * 100_000), (write_array, [0.0] * 100_000)):
    try:
        write(sys.argv[1], content)
    except OSError as error:
        print(error, os.listdir(), flush=True)
with whole_file(sys.argv[1]) as part:
    part.write_bytes(b"half of the")
    os._exit(9)
"""


def test_a_full_disk_and_a_killed_process_leave_the_old_file(tmp_path):
    path = tmp_path / "a.npy"
    write_text(path, "old")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", KILLED_ON_A_FULL_DISK, path]
    run = subprocess.run(command, env=environment, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    assert run.stdout.splitlines() == [f"[Errno 27] File too large: '{path}' ['a.npy']"] * 2
    assert run.returncode == 9 and path.read_text() == "old" and len(os.listdir(tmp_path)) == 2
    write_text(path, "new")  # what the killed one left goes with the next write
    assert os.listdir(tmp_path) == ["a.npy"]


def test_json(tmp_path):
    path, value = tmp_path / "a.json", {"seed": 2026, "loss": 1 / 3, "names": ["wyrm", "²"]}
    write_json(path, value)
    assert read_json(path) == value
    path.write_bytes(path.read_bytes()[:9])
    with pytest.raises(InputError, match="a.json: damaged"):
        read_json(path)
