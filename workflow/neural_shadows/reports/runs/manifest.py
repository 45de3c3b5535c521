"""Stage: manifest of a run, and an RO-Crate of it."""

import os
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import sha256_of, write_json
from neural_shadows.reports.data.inputs import by_folder, read_by_folder, read_seconds
from neural_shadows.reports.data.run_command import run_command
from neural_shadows.reports.runs.crate import write_crate
from neural_shadows.running.module_graph import PACKAGE, digest
from neural_shadows.running.origin import CHECKOUT, describe_origin
from neural_shadows.running.provenance import describe_hardware, read_log_line
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import Run

LOCK = CHECKOUT / "envs" / "requirements.txt"
HASHES = CHECKOUT / "envs" / "hashes.txt"


def write_manifest(
    *,
    manifest_json: Path,
    crate_json: Path,
    reports: list[Path],
    meshes: list[Path],
    on_request: Mapping[str, float],
    run: Run,
    configuration: str,
    logs: Path,
    benchmarks: Path,
) -> None:
    """Write what a run is made of, and the checksums of its reports.

    `command` is that of the last go. `jobs` counts the logs by commit and by machine: of a run in
    several goes there may be several. `time` and `stages` are of the jobs with benchmarks.

    Args:
        manifest_json: `command`, `scale`, `seed`, `commit`, `code` (digest of the package), `lock`
            (SHA-256 of envs/hashes.txt), `unlike_lock` (other installed versions), `configuration`,
            `machine`, `meshes`, `jobs`, `time`, `stages`, and `files`, by path from its folder.
        crate_json: the same files and their origin by RO-Crate's vocabulary.
        reports: all default ones; on_request: others, by path.
        meshes: mesh.json of the scenes.
        configuration: digest of all settings.
        logs, benchmarks: folders of all jobs.
    """
    paths = sorted({*map(str, reports), *on_request})
    origin = describe_origin()
    record = {
        "command": run_command(),
        "scale": run["scale"],
        "seed": run["seed"],
        "commit": origin["commit"],
        "code": digest(PACKAGE.glob("**/*.py")),
        "lock": sha256_of(HASHES),
        "unlike_lock": unlike_lock(),
        "configuration": configuration,
        "machine": origin["machine"],
        "meshes": {
            scene: {key: mesh[key] for key in ("name", "faces", "sha256")}
            for scene, mesh in read_by_folder(meshes).items()
        },
        "jobs": jobs_of(sorted(logs.glob("*/*.log"))),
        "time": time_of(benchmarks.glob("*/*.tsv")),
        "stages": {
            rule: {"jobs": len(files), "seconds": round(float(read_seconds(files)), 1)}
            for rule, files in by_folder(sorted(benchmarks.glob("*/*.tsv"))).items()
        },
        "files": {
            os.path.relpath(path, manifest_json.parent): {
                "bytes": os.path.getsize(path),
                "sha256": sha256_of(path),
            }
            for path in paths
        },
    }
    write_json(manifest_json, record)
    write_crate(crate_json, record)


def unlike_lock() -> dict[str, str]:
    """Installed versions of the lock's packages, where they are others."""
    pins: dict[str, set[str]] = {}  # several where they differ by Python
    for name, pin in re.findall(r"^([\w.-]+)==([^\s;]+)", LOCK.read_text(encoding="utf-8"), re.M):
        pins.setdefault(name, set()).add(pin)
    others = {}
    for name, allowed in pins.items():
        try:
            installed = version(name)
        except PackageNotFoundError:  # of another system
            continue
        if installed not in allowed:
            others[name] = installed
    return others


def jobs_of(logs: Sequence[Path]) -> dict[str, dict[str, int]]:
    """Count jobs by `commits` and `machines`, from the first lines of their logs."""
    lines = (path.read_text(encoding="utf-8").partition("\n")[0] for path in logs)
    origins = [origin for line in lines if (origin := read_log_line(line))]
    return {
        "commits": dict(Counter(origin["commit"] for origin in origins)),
        "machines": dict(Counter(describe_hardware(origin["machine"]) for origin in origins)),
    }


def time_of(benchmarks: Iterable[Path]) -> dict[str, Any]:
    """First start and last end of jobs, and the seconds in which at least one ran.

    A job ends when its benchmark is written: of files that were copied without their times it is wrong.
    """
    ends = [(path.stat().st_mtime, float(read_seconds([path]))) for path in benchmarks]
    spans = sorted((end - seconds, end) for end, seconds in ends)
    if not spans:
        return {}
    busy, reached = 0.0, spans[0][0]
    for start, end in spans:
        busy += max(0.0, end - max(start, reached))
        reached = max(reached, end)
    first, last = (
        datetime.fromtimestamp(stamp, UTC).isoformat(timespec="seconds")
        for stamp in (spans[0][0], reached)
    )
    return {"first_start": first, "last_end": last, "busy_seconds": round(busy, 1)}


if "snakemake" in globals():
    run_stage(snakemake, write_manifest)
