"""What every script of the workflow does around its one call: log, and errors kept readable."""

import faulthandler
import os
import shlex
import sys
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, TextIO

from neural_shadows.errors import InputError
from neural_shadows.running.job_record import JobRecord

# Of a failed job's log, shown with its error.
_LAST_LINES = 10

# Begins each log, for who looks at that of a job that was killed.
RUN_ALONE = "run it alone: "


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

    The log ends with the job's record. On an error the process ends with status 1, after the
    terminal has been told what went wrong, where the log is and how it ends, and the command
    that runs this job alone.

    Args:
        job: Snakemake's script object (`input`, `output`, `params`, `log`, `rule`, …).
    """
    path = Path(job.log[0])
    path.parent.mkdir(parents=True, exist_ok=True)
    # No error of its own for a sign that the terminal's encoding lacks, as Python's stderr.
    terminal = os.fdopen(os.dup(2), "w", buffering=1, errors="backslashreplace")
    # Nor one of the log's own, for a name of a file that is no text.
    with path.open("w", encoding="utf-8", errors="backslashreplace", buffering=1) as log:
        alone = f"{RUN_ALONE}{command_for(job.output[0], job.threads)}"
        with suppress(OSError):  # of a full disk
            log.write(f"{alone}\n")
        # By file descriptor, so that what native libraries print is captured as well.
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
        faulthandler.enable(sys.__stderr__)  # where in the job native code crashed
        sys.stdout.reconfigure(line_buffering=True)  # to be read while the job runs
        sys.stderr = _LogAndTerminal(log, terminal)
        record = JobRecord(job)
        try:
            main(job)
            log.write(record.text("done"))
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
        # A readable message says all that its traceback could.
        for last in last_lines(path, "" if readable else told):
            terminal.write(f"  | {last}\n")
        terminal.write(f"  {alone}\n")
        log.write(f"{told}{record.text(message)}{line}\n")
    sys.exit(1)


def last_lines(path: Path, more: str = "") -> list[str]:
    """The last lines of a log, to which `more` is still to be written; not its first."""
    if not path.is_file():  # a device
        return more.splitlines()[-_LAST_LINES:]
    with path.open("rb") as file:
        file.readline()
        file.seek(max(file.tell(), path.stat().st_size - 10_000))
        said = file.read().decode(errors="replace")
    return (said + more).rstrip().splitlines()[-_LAST_LINES:]


_CONFIGURATION = "NEURAL_SHADOWS_CONFIGURATION"


def remember_configuration(configfiles: Sequence[Path], settings: Sequence[str]) -> None:
    """Leave to the jobs how this run was configured, in a variable of the environment.

    Args:
        configfiles: given with `--configfile`; settings: with `--config`.
    """
    paths = [os.path.relpath(path) for path in configfiles]
    given = {"--configfile": paths, "--config": settings}
    arguments = [word for flag, values in given.items() if values for word in (flag, *values)]
    os.environ[_CONFIGURATION] = shlex.join(arguments)


def command_for(target: str, cores: int) -> str:
    """What to type in the folder that Snakemake runs in to make one file, as this run would."""
    # The target comes first: Snakemake takes all that follows --configfile for config files.
    command = f"snakemake --cores {cores} {shlex.quote(target)}"
    return f"{command} {os.environ.get(_CONFIGURATION, '')}".rstrip()
