"""What a reader must know of a run: scale, meshes, hardware, versions, commit, durations."""

import datetime
import subprocess
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from platform import python_version
from typing import Any

from neural_shadows.running.benchmark_file import read_seconds

PACKAGES = ("snakemake", "torch", "embreex", "trimesh", "numpy", "lpips")


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

    Raises:
        InputError: a file is not whole, and moved aside.
    """
    found = {}
    for folder in sorted(path for path in benchmarks.glob("*") if path.is_dir()):
        seconds = [read_seconds(path).sum() for path in sorted(folder.glob("*.tsv"))]
        if seconds:
            found[folder.name] = len(seconds), float(sum(seconds))
    return found


def run_facts(
    *,
    scale: str,
    seed: int,
    frames: str,
    meshes: Mapping[str, str],
    records: Sequence[Mapping[str, Any]],
    lpips: Mapping[str, Any],
    benchmarks: Path,
    folder: Path,
) -> list[tuple[str, str]]:
    """Names and values of the facts, in the order to show them.

    Args:
        frames: what is rendered, as a phrase.
        meshes: a phrase on the mesh of each scene.
        records: what the trainings wrote.
        lpips: what `lpips_stage` wrote.
        benchmarks: see `durations`; `folder`: the checkout.
    """
    machines = []
    for record in records:
        machine = record["machine"]
        gpu = f", {machine['gpu']}" if machine["gpu"] else ""
        machines.append(f"{machine['cpu']}, {machine['cores']} cores{gpu}")
    samples = {record["samples"] for record in records}
    times = durations(benchmarks)
    return [
        ("scale", scale),
        *((f"mesh of {scene}", text) for scene, text in meshes.items()),
        ("frames", frames),
        (
            "training",
            f"{len(records)} networks, {' or '.join(f'{n:,}' for n in sorted(samples))} samples each",
        ),
        ("LPIPS", f"network {lpips['net']}" if lpips["available"] else "not available"),
        ("seed", str(seed)),
        ("hardware", "; ".join(dict.fromkeys(machines))),
        (
            "versions",
            ", ".join([f"Python {python_version()}", *(f"{p} {version(p)}" for p in PACKAGES)]),
        ),
        ("commit", commit_of(folder)),
        (
            "durations",
            "; ".join(
                f"{rule.replace('_', ' ')} {_span(seconds)} ({count} job{'s' if count > 1 else ''})"
                for rule, (count, seconds) in times.items()
            ),
        ),
        ("made on", datetime.date.today().isoformat()),
    ]


def _span(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
