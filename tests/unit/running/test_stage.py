"""A stage's function is called by argument name; its log holds all that it says."""

import os
import pty
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from checkout import ROOT

from neural_shadows.running.origin import commit_of
from neural_shadows.running.stage import arguments_of


def test_arguments():
    def stage(
        ply: Path,
        weights: Path | None,
        origins: list[Path],
        rows,
        scene,
        n: int,
        threads,
        run_cores,
    ):
        pass

    job = SimpleNamespace(
        input={"ply": "a.ply", "weights": [], "origins": "1.npy"},
        output={},
        params={"settings": {"rows": [1, 2]}, "kind": "comparison", "scene": {}, "code": "0f"},
        # A param stands before a wildcard of its name.
        wildcards={"n": "64", "table": "table_4_3", "scene": "dragon"},
        resources={"_cores": 2, "run_cores": 4},
        threads=2,
    )
    paths = {"ply": Path("a.ply"), "weights": None, "origins": [Path("1.npy")]}
    others = {"rows": [1, 2], "scene": {}, "n": 64, "threads": 2, "run_cores": 4}
    assert arguments_of(job, stage) == paths | others


START = """
import os, sys
from types import SimpleNamespace
from neural_shadows.errors import InputError
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

names = dict(input={}, output={}, params={"code": "0123abcd"}, wildcards={}, resources={})
job = SimpleNamespace(log=["a job.log"], rule="train", threads=2, **names)

def train():
    print("print to stdout")
    print("print to stderr", file=sys.stderr)
    os.write(2, b"native stderr\\n")
    os.system("echo from a child")
    with progress_bar(2000, "samples", "train") as bar:
        bar.update(2000)
"""
SAID = ["print to stdout", "print to stderr", "native stderr", "from a child"]


def test_a_log_begins_with_what_makes_the_results(tmp_path):
    """Whatever they are: arrays and tables have no place for it."""
    first = run(tmp_path, "pass")[1].splitlines()[0]
    assert first.startswith(f"Made by commit {commit_of(ROOT)}, code 0123abcd, {{'cpu': ")


def run(folder: Path, last_line: str, stderr=subprocess.PIPE):
    """Run a stage of `train` and a last line as a script; gives the process and its log."""
    code = f"{START}    {last_line}\nrun_stage(job, train)\n"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "PYTHONUTF8": "1"},
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
    )
    return done, (folder / "a job.log").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("error", "message"),
    [
        ("InputError('a.ply: not a mesh; give a .ply')", "a.ply: not a mesh; give a .ply"),
        ("OSError(13, 'Permission denied', 'a.npy')", "[Errno 13] Permission denied: 'a.npy'"),
        (
            "OSError(28, 'No space left', 'a.npy')",
            "a.npy: No space left. Make room; the same command then continues.",
        ),
        ("RuntimeError('first\\n  second: 2048²\\n')", "RuntimeError: first second: 2048²"),
    ],
)
def test_a_job_that_fails(tmp_path, error, message):
    done, log = run(tmp_path, f"raise {error}")
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr == f"train: {message} [log: 'a job.log']\n"  # quoted: it has a space
    # In the order in which it was said, by whatever way.
    assert log.splitlines()[1:5] == SAID and log.endswith(done.stderr)
    traced = "Traceback (most recent call last)" in log and "in train" in log
    assert traced != error.startswith("InputError")


def test_a_log_on_a_full_disk(tmp_path):
    """Nothing of it can be written, so the terminal has the reason."""
    (tmp_path / "a job.log").symlink_to("/dev/full")
    code = f"{START}    pass\nrun_stage(job, train)\n"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode != 0
    assert f"disk of {tmp_path}: No space left on device. Make room" in done.stderr


def test_a_terminal_shows_the_progress(tmp_path):
    """Somebody watching sees bars and errors, but not what is printed."""
    leader, follower = pty.openpty()
    run_log = run(tmp_path, "raise InputError('wrong')", stderr=follower)[1]
    shown = os.read(leader, 100_000).decode()
    os.close(leader)
    os.close(follower)
    assert "\rtrain: 100%" in shown and "train: wrong [log: 'a job.log']" in shown
    assert "native" not in shown and "print to stdout" not in shown and "Traceback" not in shown
    assert "\r" not in run_log and "\ntrain: 100%" in run_log
