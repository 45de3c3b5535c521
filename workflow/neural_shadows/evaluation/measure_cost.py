"""The stage that measures seconds and memory of each stage, as one size grows and others stay."""

import json
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from neural_shadows.evaluation.cost_stages import NEEDED
from neural_shadows.evaluation.costs import STAGES
from neural_shadows.files.whole_files import write_json
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.stage import run_stage

# What stays as it is while one of them grows; 81,920 triangles.
BASE = dict(subdivisions=6, samples=1_000_000, width=256, views=4, frame_width=600)


def size_of(over: str, value: int) -> tuple[str, int]:
    """What a size is shown as, and its number: subdivisions as triangles, widths as pixels."""
    match over:
        case "subdivisions":
            return "triangles", 20 * 4**value
        case "frame_width":
            return "pixels", value * (value * 2 // 3)
    return over, value


def measure_cost(
    cost_json: Path, *, over: str, value: int, seed: int, device: str, threads: int
) -> None:
    """Run each stage that `over` is a size of, at that size, in a process of its own.

    Writes seconds, and memory in bytes: the peak above what the process held before the stage
    began, with all libraries loaded and kernels compiled.

    Args:
        over: a key of `STAGES`; `value`: its size, the others being those of `BASE`.

    Raises:
        CalledProcessError: a stage failed; its traceback is in the log.
    """
    settings = {"seed": seed, "device": device, "threads": threads}
    needed = dict.fromkeys(stage for last in STAGES[over] for stage in NEEDED[last])
    # Beside the result: a hundred million rays take 2 GB, which a system's /tmp may not have.
    # Named after it, so that what a failed job left is found.
    folder = cost_json.with_suffix(".unfinished")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    sizes = BASE | {over: value}
    costs = {stage: _in_process(stage, folder, sizes, settings) for stage in needed}
    shutil.rmtree(folder)
    stages = [{"stage": stage, **costs[stage]} for stage in STAGES[over]]
    name, size = size_of(over, value)
    made = {**describe_origin(), **settings}
    write_json(cost_json, {"over": name, "size": size, "stages": stages, **made})


def _in_process(
    stage: str, folder: Path, sizes: Mapping[str, int], settings: Mapping[str, Any]
) -> dict[str, float]:
    job = json.dumps({"stage": stage, "folder": str(folder), "sizes": sizes, "settings": settings})
    command = [sys.executable, "-m", "neural_shadows.evaluation.cost_stages", job]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


if "snakemake" in globals():
    run_stage(snakemake, measure_cost)
