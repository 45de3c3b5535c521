"""Rates beside their ceilings and peers, measured in turn so that all see the same machine."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import astuple, dataclass

import numpy as np
import pandas as pd
import torch

COLUMNS = ["stage", "device", "rate", "unit", "ceiling", "share", "peer", "ratio"]

Work = Callable[[], object]


@dataclass(frozen=True)
class Row:
    """A stage's rate, the rate that nothing could exceed here, and another way of doing it."""

    stage: str
    device: str
    rate: float
    unit: str
    ceiling: float | None = None  # in the same unit
    peer: str | None = None
    peer_rate: float | None = None


def table(rows: list[Row]) -> pd.DataFrame:
    """All rows under `COLUMNS`."""
    values = []
    for row in rows:
        *stage, ceiling, peer, peer_rate = astuple(row)
        share = row.rate / ceiling if ceiling else None
        values.append([*stage, ceiling, share, peer, row.rate / peer_rate if peer_rate else None])
    return pd.DataFrame(values, columns=COLUMNS)


def median_seconds(
    works: Mapping[str, Work], rounds: int, clock: str = "perf_counter"
) -> dict[str, float]:
    """Median time of each work over rounds in which each is done once, after one to warm up.

    Args:
        clock: of the module `time`; `thread_time` on a machine that is shared.
    """
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for number in range(rounds + 1):
        for name, work in works.items():
            started = getattr(time, clock)()
            work()
            if number:
                seconds[name].append(getattr(time, clock)() - started)
    return {name: float(np.median(times)) for name, times in seconds.items()}


@contextmanager
def torch_threads(threads: int) -> Iterator[None]:
    """Compute with so many of torch's threads meanwhile."""
    before = torch.get_num_threads()
    torch.set_num_threads(threads)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def with_threads(threads: int, work: Work) -> Work:
    """The work with so many of torch's threads."""

    def threaded() -> None:
        with torch_threads(threads):
            work()

    return threaded


def name_of(dtype: torch.dtype) -> str:
    """A number format's name."""
    return str(dtype).removeprefix("torch.")
