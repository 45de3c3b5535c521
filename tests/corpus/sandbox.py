"""A process that reads inputs within bounds, and says how each ended.

It is a fork of one that has loaded everything, so that an input which crashes it, hangs or
takes too much memory costs a fork, and no others.
"""

import gc
import json
import os
import resource
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

FOLDER = Path(__file__).parent
WORKFLOW = FOLDER.parents[1] / "workflow"
MIB = 2**20


class Bounds(NamedTuple):
    """What reading one input may take, above what the process held before."""

    cpu_s: int = 10
    mib: int = 256


class Outcome(NamedTuple):
    """How reading one input ended."""

    end: str
    """`works`, `clear error`, or what was wrong: `unclear error`, `memory`, `killed`."""
    message: str
    """Of the error, or the signal that killed it."""
    cpu_s: float
    mib: float


class Sandbox:
    """The process; a context manager, or `close` it."""

    def __init__(self) -> None:
        # One thread a library: a fork has none of the threads that its parent started.
        threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
        search = os.pathsep.join(map(str, (WORKFLOW, FOLDER, FOLDER.parent)))
        self._process = subprocess.Popen(
            [sys.executable, __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | threads | {"PYTHONPATH": search},
        )

    def read(self, reader: str, folder: Path, bounds: Bounds) -> Outcome:
        """Let a reader of `readers.READERS` read what lies in a folder."""
        request = {"reader": reader, "folder": str(folder), "bounds": bounds}
        print(json.dumps(request), file=self._process.stdin, flush=True)
        answer = self._process.stdout.readline()
        assert answer, "the sandbox ended"
        return Outcome(*json.loads(answer))

    def close(self) -> None:
        """End the process."""
        self._process.stdin.close()
        assert self._process.wait(60) == 0
        self._process.stdout.close()


def _held() -> dict[str, float]:
    """Memory of this process in MiB, by its names in /proc: VmRSS now, VmHWM at its most."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return {
        key: int(value.split()[0]) / 1024
        for key, _, value in (line.partition(":") for line in lines)
        if value.endswith("kB")
    }


def _attempt(reader: str, folder: str, bounds: Bounds) -> tuple[str, str]:
    """Read in this process, which an input that passes its bounds by far ends."""
    from readers import READERS

    from neural_shadows.errors import InputError

    os.chdir(folder)
    # Addresses cost nothing until they are used, so there are more of them than memory: the
    # limit stops what would otherwise take the machine's memory before it is measured.
    most = int((_held()["VmSize"] + 4 * bounds.mib) * MIB)
    resource.setrlimit(resource.RLIMIT_AS, (most, resource.RLIM_INFINITY))
    signal.setitimer(signal.ITIMER_PROF, 2 * bounds.cpu_s)
    signal.setitimer(signal.ITIMER_REAL, 600)  # for what waits; the machine may be busy
    try:
        READERS[reader].read(Path(folder))
    except InputError as error:
        cause: BaseException | None = error
        while cause := cause.__cause__:
            if isinstance(cause, MemoryError):
                return "memory", str(error)
        return "clear error", str(error)
    except BaseException as error:
        return "unclear error", f"{type(error).__name__}: {error}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
    return "works", ""


def _measured(reader: str, folder: str, bounds: Bounds) -> Outcome:
    Path("/proc/self/clear_refs").write_text("5")  # begins VmHWM anew
    before, started = _held()["VmRSS"], time.process_time()
    end, message = _attempt(reader, folder, bounds)
    cpu_s, mib = time.process_time() - started, _held()["VmHWM"] - before
    if mib > bounds.mib:
        end = "memory"
    elif cpu_s > bounds.cpu_s:
        end = "time"
    return Outcome(end, message, cpu_s, mib)


class _Worker:
    """A fork of this process that reads one input after another."""

    def __init__(self) -> None:
        here, there = socket.socketpair()
        self._pid = os.fork()
        if self._pid == 0:
            here.close()
            os.dup2(os.open(os.devnull, os.O_RDWR), 1)
            with there.makefile("rw") as file:
                for line in file:
                    request = json.loads(line)
                    outcome = _measured(**request | {"bounds": Bounds(*request["bounds"])})
                    print(json.dumps(outcome), file=file, flush=True)
            os._exit(0)
        there.close()
        self._file = here.makefile("rw")
        here.close()

    def answer(self, request: str) -> str:
        """The outcome as JSON; nothing, if that was the worker's end."""
        print(request, end="", file=self._file, flush=True)
        return self._file.readline()

    def end(self) -> str:
        """Wait for the end, and name the signal that brought it."""
        self._file.close()
        _, status = os.waitpid(self._pid, 0)
        return signal.Signals(os.WTERMSIG(status)).name if os.WIFSIGNALED(status) else ""


def _main() -> None:
    import readers

    readers.load()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    gc.freeze()  # a fork that collects garbage would copy all of it
    worker = _Worker()
    for request in sys.stdin:
        answer = worker.answer(request)
        if not answer:
            answer = json.dumps(Outcome("killed", worker.end(), 0, 0)) + "\n"
            worker = _Worker()
        print(answer, end="", flush=True)
    worker.end()


if __name__ == "__main__":
    _main()
