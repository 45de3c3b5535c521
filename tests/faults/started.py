"""The workflow in processes of its own, watched from outside and ended at a chosen moment."""

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from checkout import ROOT, Checkout

RULE = re.compile(r'^rule (\w+):.*?"\.\./scripts/(\w+)\.py"', re.MULTILINE | re.DOTALL)

# The rule that runs each script.
RULE_OF = {
    script: rule
    for path in (ROOT / "workflow" / "rules").glob("*.smk")
    for rule, script in RULE.findall(path.read_text(encoding="utf-8"))
}
SCRIPT = re.compile(r".*/\.snakemake/scripts/tmp[^./]*\.(\w+)\.py")

POLL_S = 0.03

# Within which all processes of a run end after a signal. It takes a second; but a machine that is
# busy with other things lets a process of low priority wait for minutes.
END_S = 600


@dataclass(frozen=True)
class Job:
    """A job that runs: the process of its script."""

    pid: int
    rule: str
    started: float
    """When, in seconds of `time.time`."""
    log: Path | None
    """Its log, once it writes there; before that it loads Snakemake's own modules."""


class Started:
    """A run of Snakemake in a process group of its own.

    As a context, it ends with all its processes, whatever happens.
    """

    def __init__(self, checkout: Checkout, *arguments: str, output: Path, **settings):
        self.output = output
        self.begun = time.time()
        self.longest: dict[str, float] = {}
        """Seconds of the longest job that was seen of each rule, in the order of their start."""
        with output.open("w") as file:
            self._process = subprocess.Popen(
                checkout.command(*arguments, **settings),
                cwd=checkout.folder,
                env=checkout.environment(),
                stdout=file,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def __enter__(self) -> "Started":
        return self

    def __exit__(self, *_) -> None:
        if self._members():
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()

    @property
    def ended(self) -> bool:
        return self._process.poll() is not None

    @property
    def status(self) -> int | None:
        return self._process.poll()

    @property
    def said(self) -> str:
        """All that Snakemake has said so far."""
        return self.output.read_text(encoding="utf-8", errors="replace")

    def jobs(self) -> list[Job]:
        """The jobs that run now."""
        found = []
        for pid, started in self._members().items():
            try:
                arguments = Path(f"/proc/{pid}/cmdline").read_bytes().decode().split("\0")
            except (FileNotFoundError, ProcessLookupError):
                continue  # it has just ended
            # Of bash, which starts it, the script is not an argument of its own.
            if script := next(filter(None, map(SCRIPT.fullmatch, arguments[1:2])), None):
                found.append(Job(pid, RULE_OF[script[1]], started, _log_of(pid)))
        for job in found:
            seconds = time.time() - job.started
            self.longest[job.rule] = max(self.longest.get(job.rule, 0), seconds)
        return found

    def watch(self, until: Callable[[list[Job]], bool], timeout: float) -> bool:
        """Look at the jobs until they are as wanted; False if the run ends before.

        Raises:
            TimeoutError: neither happens in `timeout` seconds.
        """
        return self.wait(lambda: until(self.jobs()), timeout, POLL_S)

    def wait(self, until: Callable[[], bool], timeout: float, poll_s: float = 0.001) -> bool:
        """As `watch`, for what can be found out faster."""
        deadline = time.monotonic() + timeout
        while True:
            ended = self.ended
            if until():
                return True
            if ended:
                return False
            if time.monotonic() > deadline:
                raise TimeoutError(f"nothing happened in {timeout:g} s:\n{self.said}")
            time.sleep(poll_s)

    def kill_snakemake_alone(self) -> list[Job]:
        """End Snakemake as the system does when memory is short; its jobs run on."""
        left = self.jobs()
        self._process.kill()
        self._process.wait()
        return left

    def interrupt(self, sign: signal.Signals) -> list[Job]:
        """Send a signal to all processes, wait for their end, and give the jobs that it hit.

        Raises:
            TimeoutError: a process is still there after `END_S`.
        """
        group = self._process.pid
        try:
            os.killpg(group, signal.SIGSTOP)  # so that what is seen is what is hit
        except ProcessLookupError:
            return []  # the run has ended
        hit = self.jobs()
        os.killpg(group, sign)
        os.killpg(group, signal.SIGCONT)
        deadline = time.monotonic() + END_S
        while left := [*self._members()]:
            if time.monotonic() > deadline:
                raise TimeoutError(f"processes {left} run on after {sign.name}:\n{self.said}")
            time.sleep(POLL_S)
        self._process.wait()
        return hit

    def _members(self) -> dict[int, float]:
        """Processes of the group that have not ended, and when they were started."""
        found = {}
        booted = time.time() - time.clock_gettime(time.CLOCK_BOOTTIME)
        for pid in map(int, filter(str.isdigit, os.listdir("/proc"))):
            try:
                # Asked first, since it takes a twentieth of the time that reading takes.
                if os.getpgid(pid) != self._process.pid:
                    continue
                # From the third field on: before it is a name in brackets, with anything in it.
                fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
            except (FileNotFoundError, ProcessLookupError):
                continue
            state, ticks = fields[0], int(fields[19])
            if state != "Z":
                found[pid] = booted + ticks / os.sysconf("SC_CLK_TCK")
        return found


def _log_of(pid: int) -> Path | None:
    try:
        said = Path(f"/proc/{pid}/fd/1").readlink()
    except OSError:
        return None  # it has just ended
    return said if said.suffix == ".log" and "logs" in said.parts else None


def rules_of(jobs: Iterable[Job]) -> list[str]:
    """The rules of some jobs, each once."""
    return sorted({job.rule for job in jobs})
