"""What a reader must know of a run: scale, meshes, hardware, versions, commit, durations."""

import datetime
import subprocess
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from platform import python_version
from typing import Any

import pandas as pd

PACKAGES = ("snakemake", "torch", "embreex", "trimesh", "numpy", "lpips")


def run_facts(
    *,
    run: Mapping[str, Any],
    meshes: Mapping[str, str],
    records: Sequence[Mapping[str, Any]],
    lpips: Mapping[str, Any] | None,
    benchmarks: Path,
    folder: Path,
) -> dict[str, str]:
    """Names and values of the facts, in the order to show them.

    Args:
        run: `scale`, `seed`, `width`, `height` (pixels); meshes: a phrase on that of each scene.
        records, lpips: what the trainings and `find_lpips` wrote.
        benchmarks: see `durations`; folder: the checkout.
    """
    facts = {"scale": run["scale"]}
    facts |= {f"mesh of {scene}": text for scene, text in meshes.items()}
    facts["frames"] = f"{run['width']} × {run['height']}"
    if records:
        samples = sorted({record["samples"] for record in records})
        counts = " or ".join(f"{count:,}" for count in samples)
        facts["training"] = f"{_counted(len(records), 'network')}, {counts} samples each"
        machines = dict.fromkeys(_machine(record["machine"]) for record in records)
        facts["hardware"] = "; ".join(machines)
    if lpips:
        facts["LPIPS"] = f"network {lpips['net']}" if lpips["available"] else "not available"
    packages = ", ".join(f"{package} {version(package)}" for package in PACKAGES)
    facts |= {
        "seed": str(run["seed"]),
        "versions": f"Python {python_version()}, {packages}",
        "commit": commit_of(folder),
        "durations": "; ".join(
            f"{rule.replace('_', ' ')} {_span(seconds)} ({_counted(count, 'job')})"
            for rule, (count, seconds) in durations(benchmarks).items()
        ),
        "made on": datetime.date.today().isoformat(),
    }
    return {name: value for name, value in facts.items() if value}


def commit_of(folder: Path) -> str:
    """The git commit that a folder is checked out at, and whether files differ from it."""
    try:
        commit = _git(folder, "rev-parse", "HEAD")
        changed = _git(folder, "status", "--porcelain", "--untracked-files=no")
    except (OSError, subprocess.CalledProcessError):
        return "not a git checkout"
    return f"{commit} with uncommitted changes" if changed else commit


def _git(folder: Path, *arguments: str) -> str:
    command = ["git", "-C", str(folder), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def durations(benchmarks: Path) -> dict[str, tuple[int, float]]:
    """Number of jobs and their seconds in all, by rule, from Snakemake's benchmark files.

    Args:
        benchmarks: the folder that has a folder for each rule.
    """
    found = {}
    for folder in sorted(path for path in benchmarks.glob("*") if path.is_dir()):
        seconds = [pd.read_csv(path, sep="\t")["s"].sum() for path in sorted(folder.glob("*.tsv"))]
        if seconds:
            found[folder.name] = len(seconds), float(sum(seconds))
    return found


def _machine(machine: Mapping[str, Any]) -> str:
    gpu = f", {machine['gpu']}" if machine["gpu"] else ""
    return f"{machine['cpu']}, {_counted(machine['cores'], 'core')}{gpu}"


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'s' if count != 1 else ''}"


def _span(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
