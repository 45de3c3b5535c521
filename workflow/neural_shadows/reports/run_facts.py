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
        benchmarks: Snakemake's, a folder for each rule; folder: the checkout.
    """
    facts = {"scale": run["scale"]}
    facts |= {f"mesh of {scene}": text for scene, text in meshes.items()}
    facts["frames"] = f"{run['width']} × {run['height']}"
    if records:
        samples = sorted({record["samples"] for record in records})
        counts = " or ".join(f"{count:,}" for count in samples)
        facts["training"] = f"{_counted(len(records), 'network')}, {counts} samples each"
        facts["hardware"] = "; ".join(dict.fromkeys(_machine(one["machine"]) for one in records))
    if lpips:
        facts["LPIPS"] = f"network {lpips['net']}" if lpips["available"] else "not available"
    facts["seed"] = str(run["seed"])
    packages = ", ".join(f"{package} {version(package)}" for package in PACKAGES)
    facts["versions"] = f"Python {python_version()}, {packages}"
    facts["commit"] = commit_of(folder)
    if spent := "; ".join(filter(None, map(_duration, sorted(benchmarks.glob("*"))))):
        facts["durations"] = spent
    return facts | {"made on": datetime.date.today().isoformat()}


def commit_of(folder: Path) -> str:
    """The git commit that a folder is checked out at, and whether files differ from it."""
    git = ["git", "-C", str(folder)]
    style = {"check": True, "capture_output": True, "text": True}
    try:
        commit = subprocess.run([*git, "rev-parse", "HEAD"], **style).stdout.strip()
        status = [*git, "status", "--porcelain", "--untracked-files=no"]
        changed = subprocess.run(status, **style).stdout
    except (OSError, subprocess.CalledProcessError):
        return "not a git checkout"
    return f"{commit} with uncommitted changes" if changed else commit


def _duration(folder: Path) -> str:
    """How long a rule's jobs took in all, and how many they were, from its benchmark files."""
    spent = [pd.read_csv(path, sep="\t")["s"].sum() for path in sorted(folder.glob("*.tsv"))]
    seconds = sum(spent)
    if seconds < 120:
        time = f"{seconds:.0f} s"
    else:
        time = f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
    rule = folder.name.replace("_", " ")
    return f"{rule} {time} ({_counted(len(spent), 'job')})" if spent else ""


def _machine(machine: Mapping[str, Any]) -> str:
    gpu = f", {machine['gpu']}" if machine["gpu"] else ""
    return f"{machine['cpu']}, {_counted(machine['cores'], 'core')}{gpu}"


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'s' if count != 1 else ''}"
