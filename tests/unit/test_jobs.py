"""A job's log holds all that it says; its terminal one line, and that only if it fails."""

import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

START = """
import os, sys, warnings
from types import SimpleNamespace
from neural_shadows.errors import InputError
from neural_shadows.jobs import run_job
from neural_shadows.progress import progress_bar

job = SimpleNamespace(log=[sys.argv[1]], rule="train", params=SimpleNamespace(width=256))

def main(job):
    print("print to stdout", job.params.width)
    print("print to stderr", file=sys.stderr)
    os.write(1, b"native stdout\\n")
    os.write(2, b"native stderr\\n")
    os.system("echo from a child")
    warnings.warn("a warning")
    with progress_bar(2000, "samples", "train") as bar:
        bar.update(2000)
"""

SAID = (
    "print to stdout 256",
    "print to stderr",
    "native stdout",
    "native stderr",
    "from a child",
    "UserWarning: a warning",
    "train: 100%",
    "2.00k/2.00k",
)


def run(tmp_path: Path, code: str, log: str = "logs/train/a job.log", **settings):
    """Run `START` + `code` as a script; gives the process and the log's text."""
    path = tmp_path / log
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "PYTHONUTF8": "1"}
    environment.pop("PYTHONUNBUFFERED", None)
    done = subprocess.run(
        [sys.executable, "-c", START + code, path],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=settings.pop("stderr", subprocess.PIPE),
        text=True,
        timeout=60,
        **settings,
    )
    return done, path.read_bytes().decode()  # as bytes, to keep a \r


def test_a_job_that_succeeds(tmp_path):
    done, log = run(tmp_path, "run_job(job, main)\n")
    assert done.returncode == 0
    assert done.stdout == done.stderr == ""
    for text in SAID:
        assert text in log
    # Everything in the order in which it was said, by whatever way.
    assert log.index(SAID[0]) < log.index(SAID[1]) < log.index(SAID[2]) < log.index(SAID[3])


@pytest.mark.parametrize(
    ("error", "told"),
    [
        ("InputError('a.ply: not a mesh; give a .ply')", "a.ply: not a mesh; give a .ply"),
        ("OSError(28, 'No space left on device', 'a.npy')", "No space left on device: 'a.npy'"),
        ("ZeroDivisionError('by zero')", "ZeroDivisionError: by zero"),
        ("RuntimeError('first line\\n  second line\\n')", "RuntimeError: first line"),
        ("InputError('2048² – π')", "2048² – π"),
    ],
)
def test_a_job_that_fails(tmp_path, error, told):
    code = f"""
def failing(job):
    main(job)
    raise {error}

run_job(job, failing)
"""
    done, log = run(tmp_path, code)
    assert done.returncode == 1
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("train: ") and told in line
    assert line.endswith(f"[log: '{tmp_path}/logs/train/a job.log']")  # quoted: it has a space
    assert "Traceback" not in line
    for text in SAID:
        assert text in log
    assert "Traceback (most recent call last)" in log and "in failing" in log
    assert log.endswith(line + "\n")


def test_a_log_on_a_full_disk(tmp_path):
    """The terminal still says why the job failed."""
    code = "def f(job):\n    print('a result')\nrun_job(job, f)\n"
    done = subprocess.run(
        [sys.executable, "-c", START + code, "/dev/full"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode != 0
    assert done.stderr == "train: [Errno 28] No space left on device [log: /dev/full]\n"


def test_the_log_is_written_while_the_job_runs(tmp_path):
    code = """
def main(job):
    print("begun")
    print("log so far:", open(job.log[0]).read().split(), file=sys.stderr)

run_job(job, main)
"""
    _, log = run(tmp_path, code)
    assert "log so far: ['begun']" in log


def test_a_new_run_replaces_the_log(tmp_path):
    (tmp_path / "a.log").write_text("old\n" * 1000)
    _, log = run(tmp_path, "run_job(job, main)\n", log="a.log")
    assert "old" not in log


def test_a_terminal_shows_the_progress(tmp_path):
    """Somebody watching sees bars and errors, but not what is printed."""
    leader, follower = pty.openpty()
    try:
        code = "def f(job):\n    main(job)\n    raise InputError('wrong')\nrun_job(job, f)\n"
        done, log = run(tmp_path, code, log="a.log", stderr=follower)
        shown = os.read(leader, 100_000).decode()
    finally:
        os.close(leader)
        os.close(follower)
    assert done.returncode == 1
    assert "\rtrain: 100%" in shown and f"train: wrong [log: {tmp_path}/a.log]" in shown
    assert "native" not in shown and "print to stdout" not in shown and "Traceback" not in shown
    assert "\r" not in log and "\ntrain: 100%" in log


def test_a_terminal_without_the_signs(tmp_path):
    code = "def f(job):\n    raise InputError(f'2048{chr(0xB2)} maps')\nrun_job(job, f)\n"
    done = subprocess.run(
        [sys.executable, "-X", "utf8=0", "-c", START + code, tmp_path / "a.log"],
        env={
            **{key: value for key, value in os.environ.items() if not key.startswith("LC_")},
            "PYTHONPATH": os.pathsep.join(sys.path),
            "LC_ALL": "C",
            "PYTHONCOERCECLOCALE": "0",
        },
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == 1
    assert done.stderr.startswith(b"train: 2048\\xb2 maps [log: ")
    assert "2048² maps" in (tmp_path / "a.log").read_text(encoding="utf-8")
