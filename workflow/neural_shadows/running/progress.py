"""How far a job is: a bar where somebody watches, else a line now and then."""

import sys
from typing import TextIO

from tqdm import tqdm

TERMINAL: TextIO | None = None
"""Where the person is, while stderr goes to a job's log (`stage.py`)."""

# Between two lines where no bar can be drawn.
_SECONDS = 20

_LINE = "{desc}: {percentage:3.0f} % of {total_fmt}{unit}, {rate_fmt}, {remaining} left"


class _LogAndTerminal:
    """Where a job's bar is written: each state a line of the log, and to the terminal."""

    def __init__(self, terminal: TextIO):
        self._terminal = terminal

    def write(self, text: str) -> None:
        line = text.strip()
        if line:
            print(line, file=sys.stderr)
        if self._terminal.isatty():
            self._terminal.write(text)
        elif line:
            print(line, file=self._terminal)

    def flush(self) -> None:
        self._terminal.flush()


def progress_bar(total: int, unit: str, title: str, initial: int = 0) -> tqdm:
    """A bar that counts to `total` units (samples, viewpoints), SI-scaled."""
    settings = dict(total=total, initial=initial, unit=f" {unit}", unit_scale=True, desc=title)
    if TERMINAL is None:
        return tqdm(**settings, dynamic_ncols=True)
    if TERMINAL.isatty():
        return tqdm(**settings, file=_LogAndTerminal(TERMINAL), mininterval=2, ncols=80)
    return tqdm(
        **settings,
        file=_LogAndTerminal(TERMINAL),
        mininterval=_SECONDS,
        maxinterval=_SECONDS,
        delay=_SECONDS,  # nothing of what takes no longer
        bar_format=_LINE,
    )
