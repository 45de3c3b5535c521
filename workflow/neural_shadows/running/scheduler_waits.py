"""Snakemake's scheduler, kept from looking at its jobs more and more often.

For its limit of jobs per second Snakemake (9.27) looks at all jobs that could run again a second
after each time that it has looked, so that each end of a job begins one more such chain of looks.
They go on while jobs wait for a core, and each asks for the size of every input of each.
"""

import threading
from typing import Any


def wait_once(scheduler: type) -> None:
    """Let all that want to look again later share one wait.

    Args:
        scheduler: Snakemake's class, whose method is replaced.
    """

    def schedule_reevaluation(self: Any, delay: float) -> None:
        def look() -> None:
            # First, so that whoever looks now finds no wait, and begins the next.
            self.waits_to_look = False
            self._open_jobs.release()

        if not getattr(self, "waits_to_look", False):
            self.waits_to_look = True
            threading.Timer(delay, look).start()

    scheduler._schedule_reevalutation = schedule_reevaluation
