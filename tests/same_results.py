"""What two runs must have in common: every file, byte by byte, save for what a run measures."""

import json
import re
import shutil
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from checkout import Checkout

# Files that hold measured times and memory, below results/<scale>, and the keys that do. All
# reports in which two runs may differ are made from these, and are the same where these are.
MEASURED = {
    # On a cluster the machine too: cores are those of the job.
    "networks/*/training.json": {"seconds", "samples_per_second", "machine"},
    "frame_times/*/*.json": {"ms", "rays_per_second"},
    "cost/*.json": {"seconds", "bytes", "peak_bytes"},
}

# What Snakemake and the jobs say on the way, below results/<scale>.
SAID = ("logs", "benchmarks")

# A run may pass midnight, and the page says how long the jobs took.
DATE = re.compile(rb"made on \d{4}-\d\d-\d\d")
FACTS = re.compile(rb"<dt>(made on|durations)</dt><dd>[^<]*")


def results_of(checkout: Checkout) -> dict[str, bytes]:
    """Content of each finished result by its path, without measured values."""
    return {
        str(path): _unmeasured(path, (checkout.results / path).read_bytes())
        for path in _files(checkout.results)
        if path.parts[0] not in SAID and not any(map(_is_unfinished, path.parts))
    }


def reports_of(checkout: Checkout) -> dict[str, bytes]:
    """Content of each report by its path, without dates and durations."""
    return {
        str(path): FACTS.sub(b"", DATE.sub(b"", (checkout.reports / path).read_bytes()))
        for path in _files(checkout.reports)
    }


def leavings_of(checkout: Checkout) -> list[str]:
    """Temporary files and what is unfinished, none of which a finished run has."""
    return sorted(
        str(path.relative_to(checkout.folder))
        for folder in (checkout.results, checkout.reports)
        for path in folder.rglob("*")
        if path.name.startswith(".")
        or any(map(_is_unfinished, path.parts))
        and path != checkout.results / "networks" / "checkpoints"
    )


def differences(found: dict[str, bytes], wanted: dict[str, bytes]) -> list[str]:
    """Names of the files that are in one of two runs alone, or are not the same."""
    return sorted(
        name for name in found.keys() | wanted.keys() if found.get(name) != wanted.get(name)
    )


def take_measured(source: Checkout, checkout: Checkout) -> None:
    """Replace a run's measured values by those of another."""
    for path in _files(source.results):
        if _keys(path):
            shutil.copy2(source.results / path, checkout.results / path)


def _files(folder: Path) -> Iterator[Path]:
    """All files below a folder that are not hidden, relative to it."""
    for path in folder.rglob("*"):
        if path.is_file() and not path.name.startswith("."):
            yield path.relative_to(folder)


def _is_unfinished(part: str) -> bool:
    return part == "checkpoints" or part.endswith(".unfinished")


def _keys(path: Path) -> set[str]:
    return next((keys for name, keys in MEASURED.items() if fnmatch(str(path), name)), set())


def _unmeasured(path: Path, content: bytes) -> bytes:
    keys = _keys(path)
    return json.dumps(_blanked(json.loads(content), keys)).encode() if keys else content


def _blanked(value: Any, keys: set[str], measured: bool = False) -> Any:
    """JSON with each number below one of the keys replaced, all else as it is."""
    if isinstance(value, dict):
        return {key: _blanked(part, keys, measured or key in keys) for key, part in value.items()}
    if isinstance(value, list):
        return [_blanked(part, keys, measured) for part in value]
    return "measured" if measured and isinstance(value, int | float) else value
