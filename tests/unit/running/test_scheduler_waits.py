"""Snakemake's scheduler looks at its jobs once for all who want it to."""

import threading

import pytest
from snakemake.scheduling.job_scheduler import JobScheduler

from neural_shadows.running.scheduler_waits import wait_once

DELAY_S = 0.05


@pytest.fixture
def scheduler() -> type:
    """A class of its own, with what Snakemake's needs to wait."""

    class Scheduler:
        _schedule_reevalutation = JobScheduler._schedule_reevalutation

        def __init__(self):
            self._open_jobs = threading.Semaphore(0)

        def looks(self) -> int:
            """How often it looks after five have asked for it."""
            for _ in range(5):
                self._schedule_reevalutation(DELAY_S)
            for timer in threading.enumerate():
                if isinstance(timer, threading.Timer):
                    timer.join()
            count = 0
            while self._open_jobs.acquire(blocking=False):
                count += 1
            return count

    return Scheduler


def test_of_snakemake_looks_for_each(scheduler):
    """When this fails, Snakemake has mended it, and the module can go."""
    assert scheduler().looks() == 5


def test_looks_once_and_then_again(scheduler):
    wait_once(scheduler)
    one = scheduler()
    assert [one.looks(), one.looks()] == [1, 1]
