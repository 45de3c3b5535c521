"""Jobs of the workflow: calls of stage functions, logs, error messages."""

import faulthandler
import gc
import inspect
import os
import shlex
import signal
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn, get_args, get_type_hints

from neural_shadows import GC_THRESHOLD
from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import is_full_disk
from neural_shadows.running import cores, origin, progress, provenance

# Used by Snakemake only: the digest of the code behind a result, files to be built along with a
# table or beside an input, the kind that names a script, and the module of a table's or figure's kind.
_RULE_ONLY = {"code", "beside", "kind", "module"}

INTERRUPTED = 130  # the shell's status after Ctrl-C


def run_stage(
    job: Any, function: Callable[..., Any], write: Callable[..., None] | None = None
) -> None:
    """Call a stage's function with a job's files and params.

    The job's log begins with commit, code and machine. Output goes there, progress to the terminal as
    well. On an error the process ends with status 1 after one line on the terminal; the traceback of any but
    an `InputError` is in the log.

    Args:
        job: Snakemake's script object (`input`, `output`, `params`, `log`, `rule`, …).
        function: takes keyword arguments named as in the rule: each named input (but `beside`),
            output and param (but `_RULE_ONLY`; those in `settings` one by one), and, if it has
            arguments of these names, `threads`, resources and wildcards.
        write: takes the function's result, and the outputs by name, which the function then does not.
    """
    gc.freeze()
    gc.set_threshold(*GC_THRESHOLD)
    # File names that are not valid text must not cause a second error.
    terminal = os.fdopen(os.dup(2), "w", buffering=1, errors="backslashreplace")
    with open(job.log[0], "w", encoding="utf-8", errors="backslashreplace", buffering=1) as log:
        # By file descriptor, which also captures output of native libraries.
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
        faulthandler.enable()  # for crashes of native code
        # Without a traceback: files are written whole or not at all.
        signal.signal(signal.SIGINT, lambda *_: os._exit(INTERRUPTED))
        sys.stdout.reconfigure(line_buffering=True)  # to be read while the job runs
        progress.TERMINAL = terminal
        origin.CODE = dict(job.params.items()).get("code")
        provenance.JOB = job
        try:
            cores.JOB = cores.JobCores(job.threads)
            print(provenance.log_line(origin.describe_origin()), file=log)
            arguments = arguments_of(job, function)
            if write is None:
                function(**arguments)
            else:
                outputs = {name: Path(arguments.pop(name)) for name in dict(job.output.items())}
                write(function(**arguments), **outputs)
        except Exception as error:
            line = f"{job.rule}: {_message(error)} [log: {shlex.quote(job.log[0])}]"
            # First, since the log's disk may be full.
            print(line, file=terminal)
            if not isinstance(error, InputError):  # whose line says what to do
                traceback.print_exc(file=log)
            print(line, file=log)
            _end(1)
        _end(0)


def _end(status: int) -> NoReturn:
    """End the process at once; all of its files are written whole, and closed, by then."""
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os._exit(status)


def _message(error: Exception) -> str:
    """One line for an error."""
    if is_full_disk(error):
        place = error.filename or f"a file on the disk of {Path.cwd()}"
        return f"{place}: {error.strerror}. Make room; the same command then continues."
    # These errors name the file and the reason; others need their type.
    kind = "" if isinstance(error, InputError | OSError) else f"{type(error).__name__}: "
    return " ".join(f"{kind}{error}".split())


def arguments_of(job: Any, function: Callable[..., None]) -> dict[str, Any]:
    """Keyword arguments of a job for its stage's function.

    See `converted`.
    """
    input, output, params, resources, wildcards = (
        dict(part.items())
        for part in (job.input, job.output, job.params, job.resources, job.wildcards)
    )
    parameters = inspect.signature(function).parameters
    optional = {"threads": job.threads, **resources, **wildcards}
    arguments = {name: value for name, value in optional.items() if name in parameters}
    arguments |= {**input, **output, **params.pop("settings", {}), **params}
    return converted(function, {k: v for k, v in arguments.items() if k not in _RULE_ONLY})


def converted(function: Callable[..., Any], arguments: dict[str, Any]) -> dict[str, Any]:
    """Arguments in the types of a function's annotations.

    Paths: `Path`, `Path | None` (None for no file) or `list[Path]`; settings: a model, or a union of
    models, from plain data; a wildcard may be an `int`. Other values stay unchanged.
    """
    types = get_type_hints(function, include_extras=True)
    return {name: _converted(value, types.get(name)) for name, value in arguments.items()}


def _converted(value: Any, type_: Any) -> Any:
    if type_ == list[Path]:
        return [Path(path) for path in ([value] if isinstance(value, str) else value)]
    if type_ is Path or type_ == Path | None:
        if value is None or isinstance(value, Path):
            return value
        # Snakemake passes the file of an input function as a list.
        paths = [value] if isinstance(value, str) else list(value)
        return Path(paths[0]) if paths else None
    if type_ is int:
        return int(value)  # a wildcard is text
    if not _holds_model(type_):
        return value
    from pydantic import TypeAdapter  # not of each job

    return TypeAdapter(type_).validate_python(value)


def _holds_model(type_: Any) -> bool:
    """Check for a model within an annotation."""
    if isinstance(type_, type):
        return hasattr(type_, "model_validate")
    return any(map(_holds_model, get_args(type_)))
