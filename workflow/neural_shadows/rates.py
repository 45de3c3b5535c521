"""How much of what a process did in what time, noted by stages for the record of their job."""

from typing import NamedTuple


class Rate(NamedTuple):
    """`count` of `unit` (samples, views) in `seconds`, under a title."""

    title: str
    unit: str
    count: int
    seconds: float

    @property
    def per_second(self) -> float:
        return self.count / max(self.seconds, 1e-9)


RATES: list[Rate] = []
"""Of this process, in the order in which they ended."""
