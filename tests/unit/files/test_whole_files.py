"""Files are whole or not there, whatever goes wrong while they are written."""

import hashlib
import os
import stat
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

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


def names(folder: Path) -> list[str]:
    """All files, the hidden temporary ones too."""
    return sorted(os.listdir(folder))


def test_file_appears_when_the_block_ends(tmp_path):
    path = tmp_path / "new" / "folder" / "mesh.ply"
    with whole_file(path) as part:
        assert part.parent == path.parent  # a rename within one file system
        assert part.name.startswith(".") and part.suffix == ".ply"
        part.write_bytes(b"ply")
        assert not path.exists()
    assert path.read_bytes() == b"ply"
    assert names(path.parent) == ["mesh.ply"]


@pytest.mark.parametrize("name", ["loss.csv", "origins.000.npy", "weights.safetensors", "README"])
def test_suffix_is_kept(tmp_path, name):
    with whole_file(str(tmp_path / name)) as part:
        assert part.suffix == (Path(name).suffix or ".part")
    assert names(tmp_path) == [name]


def test_another_process_may_read_it(tmp_path):
    write_text(tmp_path / "a.txt", "a")
    assert stat.S_IMODE((tmp_path / "a.txt").stat().st_mode) == 0o644


@pytest.mark.parametrize("error", [ValueError, OSError, KeyboardInterrupt])
def test_an_error_leaves_the_old_file(tmp_path, error):
    path = tmp_path / "a.txt"
    write_text(path, "old")
    with pytest.raises(error), whole_file(path) as part:
        part.write_text("half of the new")
        raise error
    assert path.read_text() == "old"
    assert names(tmp_path) == ["a.txt"]


def test_an_error_leaves_no_file_where_there_was_none(tmp_path):
    with pytest.raises(ValueError), whole_file(tmp_path / "a.txt"):
        raise ValueError
    assert names(tmp_path) == []


KILLED = """
import sys, time
from neural_shadows.files.whole_files import whole_file

with whole_file(sys.argv[1]) as part:
    part.write_bytes(b"half of the")
    print(part, flush=True)
    time.sleep(60)
"""


@contextmanager
def a_writer(path: Path):
    """Another process that is writing `path`; yields it and its temporary file."""
    writer = subprocess.Popen(
        [sys.executable, "-c", KILLED, path],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        stdout=subprocess.PIPE,
        text=True,
    )
    with writer:
        try:
            yield writer, Path(writer.stdout.readline().strip())
        finally:
            writer.kill()


def test_what_a_killed_process_left_goes_with_the_next_write(tmp_path):
    path, other = tmp_path / "rays [1].npy", tmp_path / "rays.npy"
    for target in (path, other):
        with a_writer(target):
            pass
    assert len(names(tmp_path)) == 2 and not path.exists()
    write_array(path, np.zeros(3))
    (left,) = [name for name in names(tmp_path) if name.startswith(".")]
    assert left.startswith(".rays.npy.")  # another file's: it goes when that one is written
    assert np.array_equal(np.load(path), np.zeros(3))


@pytest.mark.parametrize(("hours", "left"), [(1, False), (25, True)])
def test_what_another_host_left_goes_after_a_day(tmp_path, hours, left):
    """Its processes are not seen here; it may be writing."""
    part = tmp_path / ".a.txt.node-7-1-abc.part.txt"
    part.write_text("half of the")
    os.utime(part, (time.time() - 3600 * hours,) * 2)
    write_text(tmp_path / "a.txt", "mine")
    assert part.exists() != left


def test_another_process_writes_the_same_file(tmp_path):
    """What is being written is not taken for left behind: a cache that two runs share."""
    path = tmp_path / "a.txt"
    with a_writer(path) as (_, part):
        write_text(path, "mine")
        assert part.read_bytes() == b"half of the"
    assert path.read_text() == "mine"


FULL_DISK = """
import resource, signal, sys
from pathlib import Path
import numpy as np
from neural_shadows.files import whole_files as files

# A limit on a file's size gives the same short writes as a full disk.
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
folder = Path(sys.argv[1])

def tensors():
    import torch
    from neural_shadows.networks.weight_file import save_tensors
    save_tensors(folder / "a.safetensors", {"w": torch.zeros(100_000)}, {})

for write in (
    lambda: files.write_text(folder / "a.txt", "new" * 100_000),
    lambda: files.write_json(folder / "a.json", list(range(100_000))),
    lambda: files.write_array(folder / "a.npy", np.zeros(100_000)),
    tensors,
):
    try:
        write()
    except OSError as error:
        print(error)
"""


def test_a_full_disk_leaves_the_old_files(tmp_path):
    old = [f"a.{suffix}" for suffix in ("json", "npy", "safetensors", "txt")]
    for name in old:
        write_text(tmp_path / name, "old")
    done = subprocess.run(
        [sys.executable, "-c", FULL_DISK, tmp_path],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=60,
    )
    files = [f"a.{suffix}" for suffix in ("txt", "json", "npy", "safetensors")]
    lines = done.stdout.splitlines()
    assert lines == [f"[Errno 27] File too large: '{tmp_path / name}'" for name in files]
    assert names(tmp_path) == old
    assert all((tmp_path / name).read_text() == "old" for name in old)


def test_a_folder_that_cannot_be_made(tmp_path):
    write_text(tmp_path / "file", "")
    with pytest.raises(OSError), whole_file(tmp_path / "file" / "a.txt"):
        pass


def test_text_is_utf8(tmp_path):
    write_text(tmp_path / "a.txt", "2048² ≤ π\n")
    assert (tmp_path / "a.txt").read_bytes() == "2048² ≤ π\n".encode()


def test_json_round_trip(tmp_path):
    value = {"seed": 2026, "loss": 1 / 3, "names": ["wyrm", "²"], "none": None}
    write_json(tmp_path / "a.json", value)
    assert read_json(tmp_path / "a.json") == value
    text = (tmp_path / "a.json").read_text()
    assert text.endswith("}\n") and len(text.splitlines()) > 4  # to be read, and compared


@pytest.mark.parametrize(
    ("content", "reason"),
    [(None, "no such file"), (b'{"a": 1', "not a whole JSON"), (b"\xff", "JSON")],
)
def test_json_that_cannot_be_read_is_named(tmp_path, content, reason):
    path = tmp_path / "a.json"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=reason) as caught:
        read_json(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_array_round_trip(tmp_path):
    array = np.arange(6, dtype=np.float32).reshape(2, 3)
    write_array(tmp_path / "a.npy", array)
    found = np.load(tmp_path / "a.npy", allow_pickle=False)
    assert found.dtype == np.float32 and np.array_equal(found, array)
    assert names(tmp_path) == ["a.npy"]


def test_arrays_that_need_a_pickle_are_refused(tmp_path):
    with pytest.raises(ValueError, match="[Oo]bject arrays"):
        write_array(tmp_path / "a.npy", np.array([{}], dtype=object))
    assert names(tmp_path) == []


def test_sha256(tmp_path):
    of_nothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    (tmp_path / "empty").touch()
    assert sha256_of(tmp_path / "empty") == of_nothing
    content = os.urandom(1 << 20)
    (tmp_path / "a").write_bytes(content)
    assert sha256_of(tmp_path / "a") == hashlib.sha256(content).hexdigest()
