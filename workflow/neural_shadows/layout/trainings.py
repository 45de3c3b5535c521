"""Trainings of experiments, or their shipped weights: stage, files and settings."""

import os
from typing import Any

from neural_shadows.layout import frame_sets
from neural_shadows.layout.layout import Layout

_KEYS = {
    "train_on_rays": ("network", "training", "seed"),
    "train_on_frames": ("network", "training", "scenes", "lights", "seed"),
}


def stage(layout: Layout, experiment: str) -> str:
    """Stage of an experiment's training, a module of `training`."""
    on_frames = "frame_set" in layout.entry("experiments", experiment)
    return "train_on_frames" if on_frames else "train_on_rays"


def files(layout: Layout, experiment: str) -> dict[str, Any]:
    """Training data of an experiment, and mesh or pretrained weights if needed."""
    on_frames = stage(layout, experiment) == "train_on_frames"
    return _frame_files(layout, experiment) if on_frames else _ray_files(layout, experiment)


def settings(layout: Layout, experiment: str) -> dict[str, Any]:
    """Arguments of an experiment's training besides files."""
    entry = layout.entry("experiments", experiment)
    return {key: entry[key] for key in _KEYS[stage(layout, experiment)]}


def restored(layout: Layout) -> list[str]:
    """Experiments with shipped weights in place of a training."""
    return [name for name, entry in layout.settings["experiments"].items() if entry.get("weights")]


def shipped_file(layout: Layout, experiment: str) -> list[str]:
    """File of an experiment's shipped weights; none of a URL."""
    path = layout.on_frames(experiment)["weights"]["path"]
    if "://" in path:
        return []
    return [path if os.path.exists(path) else layout.source(path)]


def restored_settings(layout: Layout, experiment: str) -> dict[str, Any]:
    """Arguments of `restore_weights` besides files."""
    entry = layout.on_frames(experiment)
    return {**entry["weights"], "network": entry["network"]}


def _ray_files(layout: Layout, experiment: str) -> dict[str, Any]:
    entry = layout.on_rays(experiment)
    names = entry["scene"], entry["sampling"]
    rays = dict.fromkeys(("directions_npy", "rays_json", "origins", "bounds"), [])
    if entry["training"] is not None:
        rays = {
            "directions_npy": layout.paths.rays("directions.npy", *names),
            "rays_json": layout.paths.rays("rays.json", *names),
            **layout.shards(*names),
        }
    needed = layout.kind(experiment).needs_mesh
    return {
        "mesh_ply": [layout.paths.scene("mesh.ply", names[0])] * needed,
        "mesh_json": [layout.paths.scene("mesh.json", names[0])] * needed,
        **rays,
    }


def _frame_files(layout: Layout, experiment: str) -> dict[str, Any]:
    """Training and validation parts with arrays, and pretrained weights."""
    entry = layout.on_frames(experiment)
    frames = entry.get("frames")  # of each scene, of a point of a learning curve
    files = frames and -(-frames // layout.frames(entry["frame_set"])["shard"])
    parts = {
        use: [
            part
            for scene in entry["scenes"]
            for part in frame_sets.parts(layout, scene, entry["frame_set"], use)[:count]
        ]
        for use, count in (("train", files), ("validation", None))
    }
    beside = frame_sets.arrays(layout, entry["frame_set"], [*parts["train"], *parts["validation"]])
    return {**parts, "beside": beside, "trunk": entry["trunk"] or []}
