"""What two runs must have in common: every file, byte by byte, save for what a run measures."""

import json
import re
import shutil
from collections.abc import Iterator, Sequence
from fnmatch import fnmatch
from pathlib import Path

from checkout import Checkout

# Files that hold measured times and memory, below results/<scale>, and the keys that do. All
# reports in which two runs may differ are made from these, and are the same where these are.
MEASURED = {
    # On a cluster the machine too: cores are those of the job.
    "networks/*/training.json": {"seconds", "samples_per_second", "threads", "machine"},
    "constants/*/*/*.json": {"machine"},
    "scenes/*/mesh.json": {"machine"},
    "frames/*/*/*.json": {"machine"},
    "frame_measures/*/*.json": {"machine"},
    "screen_sensitivities/*/*.json": {"machine"},
    "times/*/*.json": {"ms", "own_ms", "rays_per_second", "machine"},
    "sun_hours/*/*.json": {"seconds", "build_seconds", "machine"},
    "screen_profiles/*.json": {"whole_ms", "product_macs", "ms", "machine"},
}

# Folders below results/<scale> of what jobs say on the way, and of what is not finished.
NO_RESULTS = re.compile(r"(^|/)(logs|benchmarks|checkpoints|[^/]+\.unfinished)/")

# The page has the last command, and says how long the jobs took. A manifest has times, and checksums of
# the page; expected minutes are of the machine's rates just then.
CHANGING = re.compile(rb"<dt>durations</dt><dd>[^<]*|<pre><code>snakemake [^<]*")
OF_ONE_RUN = (
    *("manifest.json", "ro-crate-metadata.json"),
    *(f"expected_minutes.{end}" for end in ("csv", "md", "json")),
)


def results_of(checkout: Checkout) -> dict[str, bytes]:
    """Content of each finished result by its path, without measured values."""
    return {
        str(path): _unmeasured(path, (checkout.results / path).read_bytes())
        for path in _files(checkout.results)
        if not NO_RESULTS.search(str(path))
    }


def reports_of(checkout: Checkout) -> dict[str, bytes]:
    """Content of each report by its path, without durations and those of `OF_ONE_RUN`."""
    return {
        str(path): CHANGING.sub(b"", (checkout.reports / path).read_bytes())
        for path in _files(checkout.reports)
        if path.name not in OF_ONE_RUN
    }


def leavings_of(checkout: Checkout) -> list[str]:
    """Temporary files and what is unfinished, none of which a finished run has."""
    return sorted(
        str(path.relative_to(checkout.folder))
        for folder in (checkout.results, checkout.reports)
        for path in folder.rglob("*")
        if path.name.startswith(".")
        and path.name != ".snakemake_timestamp"  # of a folder's age
        or path.suffix == ".unfinished"
        or path.parent.name == "checkpoints"
    )


def differences(found: dict[str, bytes], wanted: dict[str, bytes]) -> list[str]:
    """Names of the files that are in one of two runs alone, or are not the same."""
    return sorted(
        name for name in found.keys() | wanted.keys() if found.get(name) != wanted.get(name)
    )


def differing_reports(
    checkout: Checkout, other: Checkout, folder: Path, *targets: str, overlays: Sequence[Path] = ()
) -> list[str]:
    """Reports in which a run differs from another with its own measured values put into it.

    Args:
        folder: for a copy of the other run, which makes its reports again there.
    """
    copy = other.copy(folder)
    for path in _files(checkout.results):
        if _keys(path):
            shutil.copy2(checkout.results / path, copy.results / path)
    copy.run(*targets, overlays=overlays)
    return differences(reports_of(checkout), reports_of(copy))


def _files(folder: Path) -> Iterator[Path]:
    """All files below a folder that are not hidden, relative to it."""
    for path in folder.rglob("*"):
        if path.is_file() and not path.name.startswith("."):
            yield path.relative_to(folder)


def _keys(path: Path) -> set[str]:
    return next((keys for name, keys in MEASURED.items() if fnmatch(str(path), name)), set())


def _unmeasured(path: Path, content: bytes) -> bytes:
    keys = _keys(path)
    if not keys:
        return content

    def rest(value: dict) -> dict:
        return {key: part for key, part in value.items() if key not in keys}

    return json.dumps(json.loads(content, object_hook=rest)).encode()
