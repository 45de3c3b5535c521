"""The stage that times methods for soft shadows on the same frames, on one thread."""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.measured_frames import MeasuredFrame, measured_frames
from neural_shadows.evaluation.soft_methods.registry import METHODS
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.files.whole_files import read_json, write_json
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.running.hardware import describe_machine
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage


def time_soft_methods(
    parts: list[Path],
    constants: list[Path],
    meshes: list[Path],
    times_json: Path,
    *,
    methods: list[str],
    repeats: int = 3,
) -> None:
    """Time each method's answer on the first frame of each part, for each radius.

    All work is on one thread. Methods take turns, so that what else a machine does disturbs all of
    them alike.

    Args:
        parts: of test frames, one a scene. constants: of the methods.
        times_json: of each method and radius `ms`, the median over frames of the median over
            `repeats`, of its answer alone; `map_ms` of rasterising the light's map, which those that
            look at one need before; and the numbers in a texel, and the map's `texels`.

    Raises:
        InputError: an input file cannot be read.
    """
    frames = [one for one in measured_frames(parts, meshes) if one.number == 0]
    methods = [name for name in methods if METHODS[name].channel is None]
    radii = frames[0].part.radii
    chosen = {record["method"]: record["radii"] for record in map(read_json, constants)}
    taken: dict[str, list[list[float]]] = {name: [[] for _ in radii] for name in methods}
    maps: list[float] = []
    with progress_bar(len(frames) * len(radii), "frames", "time methods") as bar:
        for number, measured in enumerate(frames):
            frame = _prepared(measured)
            maps.append(_median(partial(_rasterised, frame), repeats))
            for k, radius in enumerate(radii):
                for name in methods:
                    if k and not METHODS[name].of_radius:
                        taken[name][k].append(taken[name][0][-1])  # it does the same again
                        continue
                    run = _run(METHODS[name], frame, radius, chosen[name][k]["constants"])
                    if number == k == 0:
                        run()  # compiles
                    taken[name][k].append(_median(run, repeats))
                bar.update()
    about = frames[0].part.about
    write_json(
        times_json,
        {
            "width": about["width"],
            "height": about["height"],
            "radii": radii,
            "frames": len(frames),
            "repeats": repeats,
            "map_ms": float(np.median(maps)),
            "texels": frames[0].frame.light_map.count,
            "methods": {
                name: {
                    "ms": [float(np.median(each)) for each in taken[name]],
                    "texel_floats": METHODS[name].texel_floats,
                }
                for name in methods
            },
            "machine": describe_machine(),
        },
    )


def _prepared(measured: MeasuredFrame) -> SoftFrame:
    """The frame with what every method is given: points, normals, the map."""
    frame = measured.frame
    for name in ("ways", "cosines", "bias", "starts", "depths"):
        getattr(frame, name)
    return frame


def _rasterised(frame: SoftFrame) -> np.ndarray:
    return replace(frame).depths


def _run(method: SoftMethod, frame: SoftFrame, radius: float, constants: Any) -> Callable[[], Any]:
    return lambda: method.answer(frame, radius, **constants)


def _median(run: Callable[[], Any], repeats: int) -> float:
    """Milliseconds of a call."""
    found = []
    for _ in range(repeats):
        started = time.perf_counter()
        run()
        found.append(time.perf_counter() - started)
    return 1000 * float(np.median(found))


if "snakemake" in globals():
    run_stage(snakemake, time_soft_methods)
