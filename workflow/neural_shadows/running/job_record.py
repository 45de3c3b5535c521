"""What a job was, on what, and how long it took: one line of JSON, and the same to read."""

import datetime
import hashlib
import json
import platform
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import sha256_of
from neural_shadows.running.process_memory import peak_bytes
from neural_shadows.running.progress import RATES


class JobRecord:
    """The record of one job, begun before its work.

    It takes the digest of every input, so that a log tells for good what a result was made of:
    SHA-256 reads 1.2 GB/s where the processor computes it (0.4 without), and what it reads is then
    in memory for the job. Nothing of the environment's variables is in it.

    Args:
        job: Snakemake's script object.
    """

    def __init__(self, job: Any):
        self._job = job
        self._started = datetime.datetime.now(datetime.UTC)
        self._begin = time.perf_counter()
        self._inputs = {name: _described(paths) for name, paths in _named(job.input)}
        self._digests = time.perf_counter() - self._begin

    def content(self, outcome: str) -> dict[str, Any]:
        """All of it, with durations up to now, ready for JSON.

        Args:
            outcome: `done`, or why the job failed.
        """
        job = self._job
        params = dict(job.params.items())
        return {
            "rule": job.rule,
            "wildcards": dict(job.wildcards.items()),
            "outcome": outcome,
            "started": self._started.isoformat(timespec="seconds"),
            "seconds": round(time.perf_counter() - self._begin, 3),
            "digest_seconds": round(self._digests, 3),
            "cpu_seconds": round(time.process_time(), 3),
            "peak_mib": peak // 2**20 if (peak := peak_bytes()) else None,
            "threads": job.threads,
            "rates": [rate._asdict() | {"per_second": rate.per_second} for rate in RATES],
            "seeds": dict(_seeds(params)),
            "params": params,
            "inputs": self._inputs,
            "outputs": {name: [str(path) for path in paths] for name, paths in _named(job.output)},
            "versions": _versions(),
        }

    def text(self, outcome: str) -> str:
        """Lines to read, and the line of JSON."""
        content = self.content(outcome)
        rates = (
            f"{rate['title']}: {rate['count']:,} {rate['unit']} in {rate['seconds']:.1f} s, "
            f"{rate['per_second']:,.6g}/s"
            for rate in content["rates"]
        )
        inputs = (
            f"{name}: {_counted(len(files))}, {sum(file['bytes'] for file in files) / 1e6:,.1f} MB, "
            f"SHA-256 {_combined(files)[:16]}"
            for name, files in content["inputs"].items()
        )
        lines = [
            f"{content['rule']}: {outcome}",
            f"  started {content['started']}, took {content['seconds']:.1f} s "
            f"({content['digest_seconds']:.1f} s for digests, {content['cpu_seconds']:.1f} s of CPU, "
            f"at most {content['peak_mib'] or '?'} MiB)",
            *(f"  rate of {rate}" for rate in rates),
            *(f"  input {line}" for line in inputs),
            *(f"  param {name}: {value}" for name, value in content["params"].items()),
            f"  versions: {', '.join(f'{name} {v}' for name, v in content['versions'].items())}",
            json.dumps(content, default=str, ensure_ascii=False),
        ]
        return "\n".join(lines) + "\n"


def _named(files: Any) -> Iterator[tuple[str, list[Path]]]:
    """Names and paths of a job's inputs or outputs."""
    for name, paths in files.items():
        yield name, [Path(path) for path in ([paths] if isinstance(paths, str) else paths)]


def _described(paths: list[Path]) -> list[dict[str, Any]]:
    """Path, bytes and SHA-256 of files; the job itself says what is wrong with one of them."""
    found = []
    for path in paths:
        with suppress(OSError):
            digest = sha256_of(path)
            found.append({"path": str(path), "bytes": path.stat().st_size, "sha256": digest})
    return found


def _combined(files: list[dict[str, Any]]) -> str:
    """The digest of one file, or one of those of several."""
    if len(files) == 1:
        return files[0]["sha256"]
    return hashlib.sha256("".join(file["sha256"] for file in files).encode()).hexdigest()


def _counted(files: int) -> str:
    return f"{files} file" if files == 1 else f"{files} files"


def _seeds(params: Mapping[str, Any], within: str = "") -> Iterator[tuple[str, Any]]:
    """Every `seed` among the params, by where it is."""
    for name, value in params.items():
        if name == "seed":
            yield f"{within}{name}", value
        elif isinstance(value, Mapping):
            yield from _seeds(value, f"{within}{name}.")


def _versions() -> dict[str, str]:
    """Versions of Python and of the packages that the job has loaded, by the names of modules."""
    found = {"python": platform.python_version()}
    loaded = {name for name in sys.modules if "." not in name} - sys.stdlib_module_names
    for name in sorted(loaded):
        # Not by getattr, which makes some packages warn.
        stated = getattr(sys.modules[name], "__dict__", {}).get("__version__")
        with suppress(PackageNotFoundError):
            found[name] = stated if isinstance(stated, str) else version(name)
    return found
