"""Progress of a job, a bar on a terminal, else lines; its warnings."""

import sys
from typing import Any, TextIO

from tqdm import tqdm

TERMINAL: TextIO | None = None
"""Snakemake's terminal, while stderr goes to a job's log (`stage.py`)."""

_SECONDS = 20  # before each line without a terminal

_BAR = "{l_bar}{bar}| {n_fmt}/{total_fmt} [{elapsed}<{remaining}, {pace}]"
_LINE = "{desc}: {percentage:3.0f} % of {total_fmt} {unit}, {pace}, {remaining} left"


class _Bar(tqdm):
    @property
    def format_dict(self) -> dict[str, Any]:
        """tqdm's values, and `pace`: units/s, or s per unit if above 1."""
        values = super().format_dict
        rate = values["rate"] or (values["n"] - values["initial"]) / (values["elapsed"] or 1)
        unit, size = values["unit"], self.format_sizeof(rate)
        pace = f"{1 / rate:.1f} s a {unit[:-1]}" if 0 < rate < 1 else f"{size} {unit}/s"
        return values | {"pace": pace}


class _LogAndTerminal:
    """Output of a bar: a log line per state, and the terminal."""

    def __init__(self, terminal: TextIO):
        self._terminal = terminal
        self.flush = terminal.flush

    def write(self, text: str) -> None:
        line = text.strip()
        if line:
            print(line, file=sys.stderr)
        if self._terminal.isatty():
            self._terminal.write(text)
        elif line:
            print(line, file=self._terminal)


def warn(text: str) -> None:
    """Print a warning to the job's log, and to the terminal."""
    for file in dict.fromkeys((sys.stderr, TERMINAL or sys.stderr)):
        print(f"warning: {text}", file=file)


def progress_bar(total: int, unit: str, title: str, initial: int = 0) -> tqdm:
    """Progress bar over `total` units, a plural such as "samples"."""
    settings = dict(total=total, initial=initial, unit=unit, desc=title, bar_format=_BAR)
    settings |= dict(unit_scale=total >= 1000, ncols=80)
    if TERMINAL:
        settings |= dict(file=_LogAndTerminal(TERMINAL), mininterval=2)
        if not TERMINAL.isatty():
            settings |= dict.fromkeys(("mininterval", "maxinterval", "delay"), _SECONDS)
            settings["bar_format"] = _LINE
    return _Bar(**settings)
