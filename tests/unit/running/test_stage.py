"""A stage's function is called by argument name; its log holds all that it says."""

import os
import pty
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from snakemake.iocontainers import InputFiles, OutputFiles, Params, Wildcards

from neural_shadows.running.stage import arguments_of, check_names


def job_of(**parts) -> SimpleNamespace:
    """A job as Snakemake hands it to a script."""
    kinds = {"input": InputFiles, "output": OutputFiles, "params": Params, "wildcards": Wildcards}
    named = {name: kind(fromdict=parts.get(name, {})) for name, kind in kinds.items()}
    return SimpleNamespace(rule="train", threads=2, log=["a.log"], **named)


def test_arguments():
    def stage(
        mesh_ply: Path,
        weights: Path | None,
        origins: list[Path],
        csv: Path,
        *,
        rows,
        size: int,
        threads,
    ):
        pass

    job = job_of(
        input={"mesh_ply": ["a.ply"], "weights": [], "origins": "1.npy", "code": ["stage.py"]},
        output={"csv": "a.csv"},
        params={"settings": {"rows": [{"method": "dragon"}]}, "kind": "comparison"},
        wildcards={"size": "64", "table": "table_4_3"},
    )
    assert arguments_of(job, stage) == {
        "mesh_ply": Path("a.ply"),
        "weights": None,
        "origins": [Path("1.npy")],
        "csv": Path("a.csv"),
        "rows": [{"method": "dragon"}],
        "size": 64,
        "threads": 2,
    }

    def write(scene):
        pass

    # A param stands before a wildcard of its name.
    job = job_of(params={"scene": {"up": "y"}}, wildcards={"scene": "dragon"})
    assert arguments_of(job, write) == {"scene": {"up": "y"}}


def test_names_that_do_not_fit():
    def write(a, b, c=0):
        pass

    check_names(write, ["a", "b"])
    with pytest.raises(TypeError, match=r"write: the rule gives too much: \['d'\], lacks: \['b'\]"):
        check_names(write, ["a", "c", "d"])


START = """
import os, sys
from types import SimpleNamespace
from neural_shadows.errors import InputError
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from snakemake.iocontainers import InputFiles, OutputFiles, Params, Wildcards

parts = {"input": InputFiles(), "output": OutputFiles(), "params": Params()}
job = SimpleNamespace(log=[sys.argv[1]], rule="train", threads=2, wildcards=Wildcards(), **parts)

def train():
    print("print to stdout")
    print("print to stderr", file=sys.stderr)
    os.write(2, b"native stderr\\n")
    os.system("echo from a child")
    with progress_bar(2000, "samples", "train") as bar:
        bar.update(2000)
"""
SAID = ["print to stdout", "print to stderr", "native stderr", "from a child"]


def run(tmp_path: Path, code: str, log: str = "logs/train/a job.log", **settings):
    """Run `START` + `code` as a script; gives the process and the log's path."""
    script, path = tmp_path / "script.py", tmp_path / log
    script.write_text(START + code, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "PYTHONUTF8": "1"}
    done = subprocess.run(
        [sys.executable, script, path],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=settings.pop("stderr", subprocess.PIPE),
        text=True,
        timeout=60,
    )
    return done, path


def test_a_job_that_succeeds(tmp_path):
    done, log = run(tmp_path, "run_stage(job, train)\n")
    assert done.returncode == 0
    assert done.stdout == done.stderr == ""
    # In the order in which it was said, by whatever way.
    assert log.read_text().splitlines() == SAID


@pytest.mark.parametrize(
    ("error", "message"),
    [
        ("InputError('a.ply: not a mesh; give a .ply')", "a.ply: not a mesh; give a .ply"),
        ("OSError(28, 'No space left', 'a.npy')", "[Errno 28] No space left: 'a.npy'"),
        (
            "RuntimeError('first line\\n  second: 2048²\\n')",
            "RuntimeError: first line second: 2048²",
        ),
    ],
)
def test_a_job_that_fails(tmp_path, error, message):
    code = f"def failing():\n    train()\n    raise {error}\nrun_stage(job, failing)\n"
    done, path = run(tmp_path, code)
    assert done.returncode == 1
    line = f"train: {message} [log: '{path}']\n"  # quoted: it has a space
    assert done.stderr == line
    log = path.read_text(encoding="utf-8")
    assert log.splitlines()[:4] == SAID and log.endswith(line)
    assert "Traceback (most recent call last)" in log and "in failing" in log


def test_where_native_code_crashed_is_in_the_log(tmp_path):
    code = "import ctypes\ndef crashing():\n    ctypes.string_at(0)\nrun_stage(job, crashing)\n"
    done, log = run(tmp_path, code)
    assert done.returncode == -signal.SIGSEGV
    assert "Segmentation fault" in log.read_text() and "in crashing" in log.read_text()


def test_a_terminal_shows_the_progress(tmp_path):
    """Somebody watching sees bars and errors, but not what is printed."""
    leader, follower = pty.openpty()
    try:
        code = "def f():\n    train()\n    raise InputError('wrong')\nrun_stage(job, f)\n"
        done, log = run(tmp_path, code, log="a.log", stderr=follower)
        shown = os.read(leader, 100_000).decode()
    finally:
        os.close(leader)
        os.close(follower)
    assert done.returncode == 1
    assert "\rtrain: 100%" in shown and f"train: wrong [log: {tmp_path}/a.log]" in shown
    assert "native" not in shown and "print to stdout" not in shown and "Traceback" not in shown
    assert "\r" not in log.read_bytes().decode() and "\ntrain: 100%" in log.read_text()
