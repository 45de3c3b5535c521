"""Rays with exact labels for the tests of networks."""

import json
import math
from pathlib import Path

import numpy as np
import torch

from neural_shadows.networks.object_space.shadow_network import LabelledBatch
from neural_shadows.rays.ray_set import RaySet


def ball_rays(count: int, seed: int = 0) -> tuple[np.ndarray, ...]:
    """Rays at a ball of radius 0.5 about the origin, half of them hits, with exact labels.

    Returns origins (n, 3), directions (n, 3), t_lb (n,), t_ub (n,), all float32.
    """
    rng = np.random.default_rng(seed)
    d = rng.normal(size=(count, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    across = rng.normal(size=(count, 3))
    across -= np.sum(across * d, axis=1, keepdims=True) * d
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    radius = np.where(rng.random(count) < 0.5, 0.5, 1.0) * np.sqrt(rng.random(count))
    half_chord = np.sqrt(1 - radius**2)
    inside = np.sqrt(np.maximum(0.25 - radius**2, 0))
    hit = radius < 0.5
    o = radius[:, None] * across - half_chord[:, None] * d
    t_lb = np.where(hit, half_chord - inside, 2 * half_chord)
    t_ub = np.where(hit, half_chord + inside, math.inf)
    return tuple(array.astype(np.float32) for array in (o, d, t_lb, t_ub))


def ball_batch(count: int, seed: int = 0) -> LabelledBatch:
    """`ball_rays` as networks take them."""
    return LabelledBatch(*map(torch.from_numpy, ball_rays(count, seed)))


def write_ball_rays(folder: Path, count: int) -> dict:
    """A ray set of `ball_rays`, one of each direction, as arguments of `train`."""
    o, d, t_lb, t_ub = ball_rays(count)
    files = {name: folder / f"{name}.npy" for name in ("directions", "origins.000", "bounds.000")}
    for path, array in zip(files.values(), (d, o[:, None], np.stack([t_lb, t_ub], 1)[:, None])):
        np.save(path, array)
    (folder / "rays.json").write_text(json.dumps({"rays": count}))
    directions, origins, bounds = files.values()
    return {
        "directions_npy": directions,
        "origins": [origins],
        "bounds": [bounds],
        "rays_json": folder / "rays.json",
    }


def open_rays(folder: Path) -> RaySet:
    """The ray set whose files are in a folder."""
    shards = (sorted(folder.glob(f"{part}.*.npy")) for part in ("origins", "bounds"))
    return RaySet(folder / "directions.npy", *shards)
