"""How much of what a process did in what time, noted by stages for the record of their job."""

from typing import NamedTuple

from tqdm import tqdm


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


class _Bar(tqdm):
    def close(self) -> None:
        if not self.disable:  # as it is once it has been closed
            seconds = self.format_dict["elapsed"]
            RATES.append(Rate(self.desc, self.unit.strip(), self.n - self.initial, seconds))
        super().close()


def progress_bar(total: int, unit: str, title: str, initial: int = 0) -> tqdm:
    """A bar on stderr that counts to `total` units (samples, viewpoints), SI-scaled.

    Closed, it leaves its rate in `rates.RATES`.
    """
    return _Bar(
        total=total,
        initial=initial,
        unit=f" {unit}",
        unit_scale=True,
        desc=title,
        mininterval=2,
        dynamic_ncols=True,
    )
