"""What two runs of one configuration must have in common: every file, byte by byte.

Aside are only the values that a run measures (times, rates) and what is made from them.
"""

import json
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from checkout import Checkout

# Files that hold measured values among others, and the keys that do.
MEASURED = {
    "results/*/networks/*/training.json": {"seconds", "samples_per_second", "machine"},
    "results/*/frame_times/*/*.json": {"ms", "rays_per_second"},
}

# What Snakemake and the jobs say on the way; reports that show measured values: tables with
# columns of times, figures and claims made from those, and the page that shows them all.
NOT_COMPARED = (
    "results/*/logs/*",
    "results/*/benchmarks/*",
    "results/*/networks/unfinished/*",
    "reports/*/table_4_6.csv",
    "reports/*/figure_4_8.*",
    "reports/*/beyond.csv",
    "reports/*/figure_beyond_dragon.*",
    "reports/*/figure_beyond_fence.*",
    "reports/*/figure_beyond_landscape.*",
    "reports/*/claims.csv",
    "reports/*/index.html",
    # Each says how long its networks were trained.
    "reports/*/*.md",
)


def results_of(checkout: Checkout) -> dict[str, bytes]:
    """What each file of the results and reports holds, without measured values.

    Not what a killed job left under a temporary, hidden name.
    """
    found = {}
    for folder in (checkout.results, checkout.reports):
        for path in (path for path in folder.rglob("*") if path.is_file()):
            name = str(path.relative_to(checkout.folder))
            if not path.name.startswith(".") and not any(fnmatch(name, p) for p in NOT_COMPARED):
                found[name] = _unmeasured(name, path)
    return found


def differences(checkout: Checkout, wanted: Checkout) -> list[str]:
    """Names of the files that are in one of two runs alone, or are not the same."""
    a, b = results_of(checkout), results_of(wanted)
    return sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))


def _unmeasured(name: str, path: Path) -> bytes:
    for pattern, keys in MEASURED.items():
        if fnmatch(name, pattern):
            return json.dumps(_without(json.loads(path.read_text()), keys)).encode()
    return path.read_bytes()


def _without(value: Any, keys: set[str]) -> Any:
    if isinstance(value, dict):
        return {key: _without(part, keys) for key, part in value.items() if key not in keys}
    if isinstance(value, list):
        return [_without(part, keys) for part in value]
    return value
