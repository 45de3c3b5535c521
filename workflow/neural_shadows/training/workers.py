"""Threads that compute the chunks of a training's steps side by side."""

import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import torch

from neural_shadows.running import cores

LOOK_SECONDS = 2.0  # between looks for idle cores


class Workers:
    """A pool of a job's threads, and of more while cores of its run are idle.

    Of the README's first command, on two cores, the thesis's network trains alone for most of its
    time: with the second core 6 minutes in place of 8 (float32, AVX2).

    They synchronise once a step. Threads inside each matrix product would synchronise 60 times, and
    all wait when another process takes a core: beside one busy process 29,000 samples/s instead of
    70,000 (batches of 16,384 on two cores).

    Args:
        threads: the job's own.
        run_cores: of the whole run, see `JobCores.take_idle`; 0 if it is not known.
        chunks: of a step; no more threads than that.
    """

    def __init__(self, threads: int, run_cores: int = 0, chunks: int = 1):
        self.run_cores, self.chunks = run_cores, chunks
        self.threads = self.most = threads
        self._pool = _pool(threads)
        self._next_look = time.monotonic() + LOOK_SECONDS

    def __enter__(self) -> "Workers":
        return self

    def __exit__(self, *_: object) -> None:
        self._pool.shutdown()

    def map(self, function: Callable[..., Any], *parts: Any) -> Iterator[Any]:
        """As `map`, side by side; results in order."""
        if cores.JOB and self.run_cores > 1 and time.monotonic() > self._next_look:
            self._look()
        return self._pool.map(function, *parts)

    def _look(self) -> None:
        self._next_look = time.monotonic() + LOOK_SECONDS
        threads = cores.JOB.take_idle(self.run_cores, self.chunks)
        if threads != self.threads:
            self._pool.shutdown()
            self._pool = _pool(threads)
            self.threads, self.most = threads, max(self.most, threads)


def _pool(threads: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(threads, initializer=torch.set_num_threads, initargs=(1,))
