"""A job sees which cores of its run no other job has, whatever way others end."""

import errno
import fcntl
import os
import signal
import subprocess
import sys

import pytest

from neural_shadows.running.cores import FOLDER, JobCores

OTHER = """
import sys
from neural_shadows.running.cores import JobCores
held = JobCores(int(sys.argv[1]))
print("held", flush=True)
sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def in_own_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def start():
    """Start another job with so many cores."""
    jobs = []

    def started(count: int) -> subprocess.Popen:
        pipe = subprocess.PIPE
        arguments = [sys.executable, "-c", OTHER, str(count)]
        jobs.append(subprocess.Popen(arguments, stdin=pipe, stdout=pipe))
        assert jobs[-1].stdout.readline() == b"held\n"
        return jobs[-1]

    yield started
    for job in jobs:
        job.communicate()


def test_takes_what_others_leave(start):
    job = JobCores(1)
    assert job.take_idle(4, most=8) == 4
    first, second = start(1), start(2)
    assert job.take_idle(4, most=8) == 1
    first.communicate()
    assert job.take_idle(4, most=8) == 2
    second.send_signal(signal.SIGKILL)
    second.wait()
    assert job.take_idle(4, most=8) == 4
    assert job.take_idle(4, most=2) == 2
    assert [path.name for path in FOLDER.iterdir()] == [str(os.getpid())]


def test_a_new_file_that_another_job_removes_is_made_again(monkeypatch):
    """A job that looks between the opening and the lock sees a file without one."""
    locked, told = fcntl.flock, []

    def flock(file, operation):
        told.append(operation)
        if len(told) == 1:
            raise BlockingIOError(errno.EAGAIN, "locked by the job that looks")
        if len(told) == 2:
            (FOLDER / str(os.getpid())).unlink()
        locked(file, operation)

    with monkeypatch.context() as patched:
        patched.setattr(fcntl, "flock", flock)
        job = JobCores(3)
    assert len(told) == 3 and job.locks
    assert (FOLDER / str(os.getpid())).read_text().strip() == "3"


def test_keeps_its_own_cores_where_others_have_them_all(start):
    job = JobCores(2)
    start(4)
    assert job.take_idle(4, most=8) == 2
    assert job.take_idle(0, most=8) == 2  # a cluster's number is not known


def test_takes_none_on_a_file_system_without_locks(monkeypatch):
    def refuse(*_):
        raise OSError(errno.ENOSYS, os.strerror(errno.ENOSYS))

    monkeypatch.setattr(fcntl, "flock", refuse)
    assert JobCores(1).take_idle(4, most=8) == 1
