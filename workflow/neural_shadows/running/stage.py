"""A job of the workflow: one call of a stage's function, with its log and readable errors."""

import faulthandler
import inspect
import os
import shlex
import signal
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_type_hints

from neural_shadows.errors import InputError
from neural_shadows.running import origin, progress

# What a rule names for Snakemake alone: a digest of the code that a result depends on, what else is
# to be made when a table is asked for or lies beside an input, and the kind of a table or figure,
# which names its script.
_RULE_ONLY = {"code", "beside", "kind"}

INTERRUPTED = 130  # the shell's status of what Ctrl-C ends


def run_stage(
    job: Any, function: Callable[..., Any], write: Callable[..., None] | None = None
) -> None:
    """Call a stage's function with a job's files and params by argument name.

    The job's log begins with what makes its results: commit, code and machine. Output goes there,
    progress to the terminal as well. On an error the process ends
    with status 1 after one line on the terminal; the traceback is in the log.

    Args:
        job: Snakemake's script object (`input`, `output`, `params`, `log`, `rule`, …).
        function: takes keyword arguments named as in the rule: each named input (but `beside`),
            output and param (but `code` and `kind`; those in `settings` one by one), and, if it has
            arguments of these names, `threads` and wildcards.
        write: takes the function's result, and the outputs by name, which the function then does not.
    """
    # A name of a file that is no text must not make an error of its own.
    terminal = os.fdopen(os.dup(2), "w", buffering=1, errors="backslashreplace")
    with open(job.log[0], "w", encoding="utf-8", errors="backslashreplace", buffering=1) as log:
        # By file descriptor, so that what native libraries print is captured as well.
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
        faulthandler.enable()  # where in the job native code crashed
        # At once and without a traceback: files are written whole or not at all.
        signal.signal(signal.SIGINT, lambda *_: os._exit(INTERRUPTED))
        sys.stdout.reconfigure(line_buffering=True)  # to be read while the job runs
        progress.TERMINAL = terminal
        origin.CODE = dict(job.params.items()).get("code")
        made = origin.describe_origin()
        print(f"Made by commit {made['commit']}, code {made['code']}, {made['machine']}", file=log)
        try:
            arguments = arguments_of(job, function)
            if write is None:
                function(**arguments)
            else:
                outputs = {name: Path(arguments.pop(name)) for name in dict(job.output.items())}
                write(function(**arguments), **outputs)
        except Exception as error:
            # An error of these names the file and the reason, others need their type.
            kind = "" if isinstance(error, InputError | OSError) else f"{type(error).__name__}: "
            message = " ".join(f"{kind}{error}".split())
            line = f"{job.rule}: {message} [log: {shlex.quote(job.log[0])}]"
            # First, for the log may lie on a disk that is full.
            print(line, file=terminal)
            print(traceback.format_exc(), line, sep="\n", file=log)
            sys.exit(1)


def arguments_of(job: Any, function: Callable[..., None]) -> dict[str, Any]:
    """What a job hands to its stage's function.

    Paths become what the argument's annotation says: `Path`, `Path | None` (None for no file) or
    `list[Path]`; anything else stays as it is, but a wildcard may be an `int`.
    """
    input, output, params, wildcards = (
        dict(part.items()) for part in (job.input, job.output, job.params, job.wildcards)
    )
    takes = inspect.signature(function).parameters
    offered = {"threads": job.threads, **wildcards}
    given = {name: value for name, value in offered.items() if name in takes}
    given |= {**input, **output, **params.pop("settings", {}), **params}
    given = {name: value for name, value in given.items() if name not in _RULE_ONLY}
    types = get_type_hints(function)
    return {name: _converted(value, types.get(name)) for name, value in given.items()}


def _converted(value: Any, type_: Any) -> Any:
    if type_ == list[Path]:
        return [Path(path) for path in ([value] if isinstance(value, str) else value)]
    if type_ is Path or type_ == Path | None:
        # Snakemake gives a function's file as a list of one.
        paths = [value] if isinstance(value, str) else list(value)
        return Path(paths[0]) if paths else None
    return int(value) if type_ is int else value  # a wildcard is text
