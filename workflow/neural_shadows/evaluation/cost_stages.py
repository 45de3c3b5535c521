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

SCENE = {"up": "y", "ground": True, "light": {"domain": "sphere", "min_elevation_deg": 20}}
SAMPLING = {
    "sampler": "poisson_quadtree",
    "points_per_direction": POINTS_PER_DIRECTION,
    "silhouette_resolution": 128,
    "min_quad": 1,
}
TRAINING = {
    "steps": 200,
    "batch_size": 1024,
    "learning_rate": 1e-4,
    "schedule": "constant",
    "loss": {},
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
    files = (source, folder / "mesh.ply", folder / "mesh.json")
    return partial(prepare_mesh, *files, mesh={}, name="bumpy sphere")


def _rays(folder: Path, sizes: Sizes, settings: Settings) -> Work:
    from neural_shadows.rays.draw_directions import draw_directions
    from neural_shadows.rays.sample_rays import sample_rays

    shard = _shard(folder, sizes, settings)
    sampling = SAMPLING | {"directions": shard["last"]}
    draw_directions(
        directions_npy=shard["directions_npy"], sampling=sampling, seed=settings["seed"]
    )
    return partial(sample_rays, sampling=sampling, **shard)


def _labels(folder: Path, sizes: Sizes, settings: Settings) -> Work:
    from neural_shadows.rays.label_rays import label_rays

    return partial(label_rays, bounds_npy=folder / "bounds.npy", **_shard(folder, sizes, settings))


def _shard(folder: Path, sizes: Sizes, settings: Settings) -> dict[str, Any]:
    """What `sample_rays` and `label_rays` both take."""
    return {
        "mesh_ply": folder / "mesh.ply",
        "directions_npy": folder / "directions.npy",
        "origins_npy": folder / "origins.npy",
        "first": 0,
        "last": sizes["samples"] // POINTS_PER_DIRECTION,
        "seed": settings["seed"],
        "threads": settings["threads"],
    }


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
        network=_network(sizes),
        training=TRAINING,
        experiment="cost",
        **settings,
    )


def _network(sizes: Sizes) -> dict[str, Any]:
    width = sizes["width"]
    return {"encoding": "frequency", "frequencies": 10, "width": width, "hidden_layers": 8}


def _evaluation(folder: Path, sizes: Sizes, settings: Settings) -> Work:
    """The reference, a shadow map and an untrained network on one thread, as each job has."""
    from neural_shadows.evaluation.evaluate import evaluate
    from neural_shadows.evaluation.render_references import render_references
    from neural_shadows.networks.kinds import make_network
    from neural_shadows.networks.weight_file import save_network

    network = make_network(_network(sizes))
    network.initialise(settings["seed"])
    weights = folder / "untrained.safetensors"
    save_network(weights, network, {"network": _network(sizes)})
    lpips_json = folder / "lpips.json"
    write_json(lpips_json, {"available": False})
    width, seed = sizes["frame_width"], settings["seed"]
    frames = {"width": width, "height": width * 2 // 3, "view_sets": ["surface"], "seed": seed}
    mesh_ply, references = folder / "mesh.ply", folder / "references.safetensors"

    def work() -> None:
        batch = {"scene": SCENE, "frames": frames, "first": 0, "last": sizes["views"]}
        render_references(mesh_ply, references, folder / "reference.npz", **batch)
        for method, file in {"shadow_map_512": None, "network": weights}.items():
            outputs = (folder / f"{method}.csv", folder / f"{method}.npz")
            inputs = (references, mesh_ply, file, None, lpips_json)
            evaluate(*inputs, *outputs, method=method, scene=SCENE, device=settings["device"])

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
    job = json.loads(sys.argv[1])
    print(json.dumps(run_alone(**job | {"folder": Path(job["folder"])})))
