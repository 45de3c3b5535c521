"""Each stage whose cost is measured, run once in a process of its own.

python -m neural_shadows.evaluation.cost_stages '{"stage": "rays", "folder": …}'
"""

import json
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import write_json
from neural_shadows.running.process_memory import held_bytes, peak_bytes

POINTS_PER_DIRECTION = 10_000  # the thesis's [4.1]
TRAINING_STEPS = 200
BATCH_SIZE = 1024

SCENE = {"up": "y", "ground": True, "light": {"domain": "sphere", "min_elevation_deg": 20}}
SAMPLING = {
    "sampler": "poisson_quadtree",
    "points_per_direction": POINTS_PER_DIRECTION,
    "silhouette_resolution": 128,
    "min_quad": 1,
}

# Sizes of the run that warms a stage up: libraries loaded, kernels compiled.
TINY = {
    "subdivisions": 2,
    "samples": POINTS_PER_DIRECTION,
    "width": 16,
    "views": 1,
    "frame_width": 48,
}

# The stages whose files each needs, and itself.
NEEDED = {
    "mesh": ("mesh",),
    "rays": ("mesh", "rays"),
    "labels": ("mesh", "rays", "labels"),
    "training": ("mesh", "rays", "labels", "training"),
    "evaluation": ("mesh", "evaluation"),
}

Sizes = Mapping[str, int]
Settings = Mapping[str, Any]
Work = Callable[[], object]


def frame_height(frame_width: int) -> int:
    """Of a measured frame, in pixels."""
    return frame_width * 2 // 3


def bumpy_sphere(subdivisions: int):
    """A sphere with waves, which shadow each other, as a mesh of 20 · 4^subdivisions triangles."""
    import numpy as np
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions)
    waves = np.sin(7 * ball.vertices).prod(axis=1, keepdims=True)
    return trimesh.Trimesh(ball.vertices * (1 + 0.3 * waves), ball.faces, process=False)


def _mesh(folder: Path, sizes: Sizes, settings: Settings) -> Work:
    from neural_shadows.meshes.prepare_mesh import prepare_mesh

    source = folder / "source.ply"
    bumpy_sphere(sizes["subdivisions"]).export(source)
    return partial(
        prepare_mesh,
        source,
        folder / "mesh.ply",
        folder / "mesh.json",
        mesh={},
        name="bumpy sphere",
    )


def _directions(sizes: Sizes) -> int:
    return sizes["samples"] // POINTS_PER_DIRECTION


def _shard(folder: Path, sizes: Sizes, settings: Settings) -> dict[str, Any]:
    """What `sample_rays` and `label_rays` both take."""
    return {
        "mesh_ply": folder / "mesh.ply",
        "directions_npy": folder / "directions.npy",
        "origins_npy": folder / "origins.npy",
        "first": 0,
        "last": _directions(sizes),
        "seed": settings["seed"],
        "threads": settings["threads"],
    }


def _rays(folder: Path, sizes: Sizes, settings: Settings) -> Work:
    from neural_shadows.rays.draw_directions import draw_directions
    from neural_shadows.rays.sample_rays import sample_rays

    sampling = SAMPLING | {"directions": _directions(sizes)}
    shard = _shard(folder, sizes, settings)
    draw_directions(
        directions_npy=shard["directions_npy"], sampling=sampling, seed=settings["seed"]
    )
    return partial(sample_rays, sampling=sampling, **shard)


def _labels(folder: Path, sizes: Sizes, settings: Settings) -> Work:
    from neural_shadows.rays.label_rays import label_rays

    return partial(label_rays, bounds_npy=folder / "bounds.npy", **_shard(folder, sizes, settings))


def _network(width: int) -> dict[str, Any]:
    return {"encoding": "frequency", "frequencies": 10, "width": width, "hidden_layers": 8}


def _training(folder: Path, sizes: Sizes, settings: Settings) -> Work:
    from neural_shadows.training.train import train

    write_json(folder / "rays.json", {})
    return partial(
        train,
        directions_npy=folder / "directions.npy",
        origins=[folder / "origins.npy"],
        bounds=[folder / "bounds.npy"],
        rays_json=folder / "rays.json",
        mesh_ply=None,
        weights=folder / "trained" / "weights.safetensors",
        loss_csv=folder / "loss.csv",
        training_json=folder / "training.json",
        network=_network(sizes["width"]),
        training={
            "steps": TRAINING_STEPS,
            "batch_size": BATCH_SIZE,
            "learning_rate": 1e-4,
            "schedule": "constant",
            "loss": {},
        },
        experiment="cost",
        **settings,
    )


def _evaluation(folder: Path, sizes: Sizes, settings: Settings) -> Work:
    """The reference, a shadow map and an untrained network on one thread, as each job has."""
    from neural_shadows.evaluation.evaluate import evaluate
    from neural_shadows.evaluation.render_references import render_references
    from neural_shadows.networks.kinds import make_network
    from neural_shadows.networks.weight_file import save_network

    network = make_network(_network(sizes["width"]))
    network.initialise(settings["seed"])
    weights = folder / "untrained.safetensors"
    save_network(weights, network, {"network": _network(sizes["width"])})
    lpips_json = folder / "lpips.json"
    write_json(lpips_json, {"available": False})
    width = sizes["frame_width"]
    frames = {
        "width": width,
        "height": frame_height(width),
        "view_sets": ["surface"],
        "seed": settings["seed"],
    }
    references = folder / "references.safetensors"

    def work() -> None:
        render_references(
            folder / "mesh.ply",
            references,
            folder / "reference.npz",
            scene=SCENE,
            frames=frames,
            first=0,
            last=sizes["views"],
        )
        for method, file in {"shadow_map_512": None, "network": weights}.items():
            evaluate(
                references,
                folder / "mesh.ply",
                file,
                None,
                lpips_json,
                folder / f"{method}.csv",
                folder / f"{method}.npz",
                method=method,
                scene=SCENE,
                device=settings["device"],
            )

    return work


WORKS: dict[str, Callable[[Path, Sizes, Settings], Work]] = {
    "mesh": _mesh,
    "rays": _rays,
    "labels": _labels,
    "training": _training,
    "evaluation": _evaluation,
}
"""By stage: lays out what the work is given on files in a folder, and gives the work itself."""


def run_alone(stage: str, folder: Path, sizes: Sizes, settings: Settings) -> dict[str, float]:
    """Warm a stage up and run it: seconds, and memory in bytes.

    Args:
        folder: with the files of the stages that it needs.
        settings: `seed`, `device` and `threads`.
    """
    with tempfile.TemporaryDirectory(dir=folder) as small:
        for needed in NEEDED[stage]:
            WORKS[needed](Path(small), TINY, settings)()
    work = WORKS[stage](folder, sizes, settings)
    before = held_bytes()
    started = time.perf_counter()
    work()
    seconds = time.perf_counter() - started
    peak = peak_bytes()
    return {"seconds": seconds, "bytes": max(0, peak - before), "peak_bytes": peak}


if __name__ == "__main__":
    try:
        job = json.loads(sys.argv[1])
        print(json.dumps(run_alone(**job | {"folder": Path(job["folder"])})))
    except Exception as error:
        print(f"{type(error).__name__}: {error}")
        raise
