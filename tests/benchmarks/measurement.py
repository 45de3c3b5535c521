"""Rates beside their ceilings and peers, measured in turn so that all see the same machine."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

COLUMNS = ["stage", "device", "rate", "unit", "ceiling", "share", "peer", "ratio"]


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

    def values(self) -> list:
        """What stands in the columns."""
        share = self.rate / self.ceiling if self.ceiling else None
        ratio = self.rate / self.peer_rate if self.peer_rate else None
        ceiling = (self.ceiling, share)
        return [self.stage, self.device, self.rate, self.unit, *ceiling, self.peer, ratio]


def table(rows: list[Row]) -> pd.DataFrame:
    """All rows under `COLUMNS`."""
    return pd.DataFrame([row.values() for row in rows], columns=COLUMNS)


def median_seconds(
    works: Mapping[str, Callable[[], object]], rounds: int, clock: str = "perf_counter"
) -> dict[str, float]:
    """Median time of each work over rounds in which each is done once, after one to warm up.

    Args:
        clock: of module `time`; with `thread_time` what else runs on the machine counts less, but
            the works must be done by the calling thread alone.
    """
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for number in range(rounds + 1):
        for name, work in works.items():
            started = getattr(time, clock)()
            work()
            if number:
                seconds[name].append(getattr(time, clock)() - started)
    return {name: float(np.median(times)) for name, times in seconds.items()}
