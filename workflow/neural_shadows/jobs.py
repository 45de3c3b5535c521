"""What every script of the workflow does around its one call: log, and errors kept readable."""

import os
import shlex
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any, TextIO

from neural_shadows.errors import InputError


class _LogAndTerminal:
    """Writes to the log, and to the terminal too where somebody watches it.

    A progress bar overwrites its line on a terminal; in the log each state is a line.
    """

    encoding = "utf-8"  # what progress bars ask before they draw blocks

    def __init__(self, log: TextIO, terminal: TextIO):
        self._log, self._terminal = log, terminal

    def write(self, text: str) -> int:
        self._log.write(text.replace("\r", "\n"))
        if self._terminal.isatty():
            self._terminal.write(text)
        return len(text)

    def isatty(self) -> bool:
        return False  # asked before colours are written, which a log should not hold

    def flush(self) -> None:
        self._log.flush()
        self._terminal.flush()


def run_job(job: Any, main: Callable[[Any], None]) -> None:
    """Run `main(job)` with stdout, stderr and a traceback captured in the job's log.

    Ends the process with status 1 on an error, after one line on the terminal that says what
    went wrong and where the log is.

    Args:
        job: Snakemake's script object (`input`, `output`, `params`, `log`, `rule`, …).
    """
    path = Path(job.log[0])
    path.parent.mkdir(parents=True, exist_ok=True)
    # No error of its own for a sign that the terminal's encoding lacks, as Python's stderr.
    terminal = os.fdopen(os.dup(2), "w", buffering=1, errors="backslashreplace")
    with path.open("w", encoding="utf-8", buffering=1) as log:
        # By file descriptor, so that what native libraries print is captured as well.
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
        sys.stdout.reconfigure(line_buffering=True)  # to be read while the job runs
        sys.stderr = _LogAndTerminal(log, terminal)
        try:
            main(job)
            return
        except Exception as caught:
            error, told = caught, traceback.format_exc()
        finally:
            sys.stderr = sys.__stderr__
        # Messages of these name the file and the reason: a full disk is an OSError.
        readable = isinstance(error, InputError | OSError)
        message = str(error) if readable else f"{type(error).__name__}: {error}"
        message = message.strip().replace("\n", " ")
        line = f"{job.rule}: {message} [log: {shlex.quote(str(path))}]"
        # First, for the log may lie on the disk that is full.
        terminal.write(line + "\n")
        log.write(f"{told}{line}\n")
    sys.exit(1)
