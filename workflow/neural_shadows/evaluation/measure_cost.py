"""How long each stage takes, and how much memory, as one size grows and the others stay."""

import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from neural_shadows.evaluation.costs import STAGES
from neural_shadows.files.whole_files import write_json
from neural_shadows.running.hardware import describe_machine
from neural_shadows.running.process_memory import held_bytes, peak_bytes

POINTS_PER_DIRECTION = 10_000  # the thesis's [4.1]

# What stays as it is while one of them grows.
BASE = {
    "subdivisions": 6,  # 81,920 triangles
    "samples": 1_000_000,
    "width": 256,
    "views": 4,
    "frame_width": 600,
}
# Sizes of the run that warms a stage up: libraries loaded, kernels compiled.
TINY = {
    "subdivisions": 2,
    "samples": POINTS_PER_DIRECTION,
    "width": 16,
    "views": 1,
    "frame_width": 48,
}
NEEDED = {
    "mesh": ("mesh",),
    "rays": ("mesh", "rays"),
    "labels": ("mesh", "rays", "labels"),
    "training": ("mesh", "rays", "labels", "training"),
    "evaluation": ("mesh", "evaluation"),
}
TRAINING_STEPS = 200
BATCH_SIZE = 1024


def size_of(over: str, value: int) -> tuple[str, int]:
    """What a size is shown as, and its number: subdivisions as triangles, widths as pixels."""
    match over:
        case "subdivisions":
            return "triangles", 20 * 4**value
        case "frame_width":
            return "pixels", value * _height(value)
    return over, value


def _height(frame_width: int) -> int:
    return frame_width * 2 // 3


def measure_cost(
    cost_json: Path, *, over: str, value: int, seed: int, device: str, precision: str, threads: int
) -> None:
    """Run each stage that `over` is a size of, at that size, in a process of its own.

    Writes seconds, and memory in bytes: the peak above what the process held before the stage
    began, with all libraries loaded and kernels compiled.

    Args:
        over: a key of `STAGES`; `value`: its size, the others being those of `BASE`.

    Raises:
        RuntimeError: a stage failed; its message is in the log.
    """
    settings = {"seed": seed, "device": device, "precision": precision, "threads": threads}
    found = []
    # Beside the result: a hundred million rays take 2 GB, which a system's /tmp may not have.
    # Named after it, so that what a killed job left is found.
    folder = cost_json.with_suffix(".unfinished")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    try:
        sizes = BASE | {over: value}
        measured = STAGES[over]
        done: set[str] = set()
        for stage in measured:
            for needed in NEEDED[stage]:
                if needed not in done:
                    result = _in_process(needed, folder, sizes, settings)
                    done.add(needed)
                    if needed in measured:
                        found.append({"stage": needed, **result})
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    name, size = size_of(over, value)
    write_json(
        cost_json,
        {"over": name, "size": size, "stages": found, "machine": describe_machine(), **settings},
    )


def _in_process(stage: str, folder: Path, sizes: Mapping[str, int], settings: Mapping[str, Any]):
    job = json.dumps({"stage": stage, "folder": str(folder), "sizes": sizes, "settings": settings})
    done = subprocess.run(
        [sys.executable, "-m", "neural_shadows.evaluation.measure_cost", job],
        stdout=subprocess.PIPE,
        text=True,
    )
    if done.returncode:
        # Its traceback is in the log, or not, where that lies on a disk that is full.
        reason = done.stdout.strip() or f"ended with status {done.returncode}"
        raise RuntimeError(f"{stage} at {sizes}: {reason}")
    return json.loads(done.stdout.splitlines()[-1])


def bumpy_sphere(subdivisions: int) -> trimesh.Trimesh:
    """A sphere with waves, which shadow each other: 20 · 4^subdivisions triangles."""
    ball = trimesh.creation.icosphere(subdivisions)
    waves = np.sin(7 * ball.vertices).prod(axis=1, keepdims=True)
    return trimesh.Trimesh(ball.vertices * (1 + 0.3 * waves), ball.faces, process=False)


def stage_work(
    stage: str, folder: Path, sizes: Mapping[str, int], settings: Mapping[str, Any]
) -> Callable[[], object]:
    """One stage as the workflow runs it, on files in `folder`, ready to be called."""
    mesh_ply, directions = folder / "mesh.ply", folder / "directions.npy"
    origins, bounds = folder / "origins.000.npy", folder / "bounds.000.npy"
    count = sizes["samples"] // POINTS_PER_DIRECTION
    part = {"first": 0, "last": count, "threads": settings["threads"]}
    network = {
        "encoding": "frequency",
        "frequencies": 10,
        "width": sizes["width"],
        "hidden_layers": 8,
    }
    match stage:
        case "mesh":
            from neural_shadows.meshes.prepare_mesh import prepare_mesh

            source = folder / "source.ply"
            bumpy_sphere(sizes["subdivisions"]).export(source)
            return lambda: prepare_mesh(source, mesh_ply, folder / "mesh.json", name="bumpy sphere")
        case "rays":
            from neural_shadows.rays.draw_directions import make_directions
            from neural_shadows.rays.sample_rays import make_rays

            sampler, seed = "poisson_quadtree", settings["seed"]
            make_directions(directions, sampler=sampler, directions=count, seed=seed)
            return lambda: make_rays(
                mesh_ply,
                directions,
                origins,
                sampler=sampler,
                points_per_direction=POINTS_PER_DIRECTION,
                silhouette_resolution=128,
                min_quad=1,
                seed=seed,
                **part,
            )
        case "labels":
            from neural_shadows.rays.label_rays import make_labels

            seed = settings["seed"]
            return lambda: make_labels(mesh_ply, directions, origins, bounds, seed=seed, **part)
        case "training":
            from neural_shadows.rays.ray_set import RaySet
            from neural_shadows.training.train import train

            return lambda: train(
                RaySet(directions, [origins], [bounds]),
                folder / "weights.safetensors",
                folder / "loss.csv",
                folder / "training.json",
                name="cost",
                network=network,
                steps=TRAINING_STEPS,
                batch_size=BATCH_SIZE,
                learning_rate=1e-4,
                schedule="constant",
                loss={},
                mesh_ply=None,
                data={},
                state_folder=folder / "unfinished",
                **settings,
            )
    from neural_shadows.evaluation.evaluate import evaluate
    from neural_shadows.networks.kinds import make_network
    from neural_shadows.networks.weight_file import save_network

    made = make_network(network)
    made.initialise(settings["seed"])
    save_network(folder / "untrained.safetensors", made, {"network": network})
    write_json(
        folder / "lpips.json",
        {"net": "alex", "trunk": None, "available": False, "reason": "not measured"},
    )
    width = sizes["frame_width"]
    frames = {
        "up": "y",
        "ground": True,
        "light": {"domain": "sphere", "min_elevation_deg": 20},
        "width": width,
        "height": _height(width),
        "seed": settings["seed"],
    }
    return lambda: evaluate(
        mesh_ply,
        folder / "lpips.json",
        {"network": folder / "untrained.safetensors"},
        {"network": 0.0},
        folder / "metrics.csv",
        folder / "pictures.npz",
        shadow_maps=[512],
        view_set="surface",
        first=0,
        last=sizes["views"],
        frames=frames,
        reference="exact",
        device=settings["device"],
        precision=settings["precision"],
        threads=1,  # as an evaluation job has
    )


def _main(job: Mapping[str, Any]) -> None:
    """Warm one stage up, run it, and print its seconds and its memory as JSON."""
    stage, settings = job["stage"], job["settings"]
    with tempfile.TemporaryDirectory(dir=job["folder"]) as folder:
        for needed in NEEDED[stage]:
            stage_work(needed, Path(folder), TINY, settings)()
    work = stage_work(stage, Path(job["folder"]), job["sizes"], settings)
    before = held_bytes()
    started = time.perf_counter()
    work()
    seconds = time.perf_counter() - started
    peak = peak_bytes()
    print(json.dumps({"seconds": seconds, "bytes": max(0, peak - before), "peak_bytes": peak}))


if __name__ == "__main__":
    try:
        _main(json.loads(sys.argv[1]))
    except Exception as error:
        print(f"{type(error).__name__}: {error}")
        raise
