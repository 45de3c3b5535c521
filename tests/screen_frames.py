"""A part of a frame set that is made by hand: the shadow of a straight edge on a wall, seen head on."""

import json
from pathlib import Path

import numpy as np

from neural_shadows.frames.buffers import CHANNELS

WIDTH, HEIGHT = 64, 32
RADII = (0.0, 0.25)
SETTING = {
    **{"eye": [0, 0, 1], "target": [0, 0, 0], "fov_deg": 55, "window": None},
    **{"light": [0, 1, 1], "motion": np.eye(4).tolist()},
}

# Of a short training on them.
FEATURES = ["c_e", "view", "ratio", "difference"]
TRAINING = {
    **{
        "optimiser": "adam",
        "steps": 6,
        "crops": 2,
        "crop": 16,
        "learning_rate": 5e-3,
        "schedule": "cosine",
    },
    **{
        "alpha": 0.9,
        "perceptual": {"net": "none"},
        "perturbation": 3.0,
        "perturbation_from": 0.0,
        "aligned": False,
        "flips": True,
    },
}


def edge(column: float, soft: float = 0.0) -> np.ndarray:
    """Visibility (HEIGHT, WIDTH) beside an edge, dark on its left, `soft` pixels wide on each side."""
    beyond = np.tile(np.arange(WIDTH) + 0.5 - column, (HEIGHT, 1))
    return np.clip(0.5 + beyond / (2 * soft), 0, 1) if soft else np.float64(beyond > 0)


def write_frames(
    folder: Path,
    use: str = "train",
    count: int = 1,
    twins: int = 1,
    shift: float = 1.0,
    rays: int = 0,
) -> Path:
    """Frames whose twins have the edge `shift` pixels farther right; gives the part's JSON.

    Rays, if any, have its target with noise, and penumbrae of one width.
    """
    folder.mkdir(parents=True, exist_ok=True)
    shape = (count, 1 + twins, len(CHANNELS), HEIGHT, WIDTH)
    buffers, targets = np.zeros(shape, np.float16), np.zeros((count, 2, *shape[-2:]), np.float16)
    for number in range(count):
        column = 24 + 6 * number
        targets[number] = edge(column), edge(column, soft=4.0)
        for twin in range(1 + twins):
            hard = edge(column + shift * twin)
            constant = {"z": 0.9, "d": 0.6, "c_e": 0.7, "c_v": 0.3, "agreement": 1.0}
            lit = dict.fromkeys(("hard", "pcf", "msm"), hard)
            for name, value in {**constant, **lit, "gap": 0.8 * (hard - 1)}.items():
                buffers[number, twin, CHANNELS.index(name)] = value
    path = folder / f"{use}_000.json"
    frames = [{"setting": SETTING, "twins": [SETTING] * twins}] * count
    about = {"channels": CHANNELS, "radii": RADII, "size": 4.0, "frames": frames}
    path.write_text(json.dumps(about | {"width": WIDTH, "height": HEIGHT, "rays": rays}))
    if rays:
        noise = np.random.default_rng(0).random((rays, *targets.shape))
        seen = (noise < targets).mean(0)
        penumbrae = np.where(seen < 1, 0.01, -1)
        np.save(
            path.with_suffix(".rays.npy"), np.stack([seen, penumbrae], axis=2).astype(np.float16)
        )
    valid = np.ones((count, 1 + twins, *shape[-2:]), bool)
    valid[..., :2] = False  # a margin that does not count
    for stem, array in {"buffers": buffers, "targets": targets, "valid": valid}.items():
        np.save(path.with_suffix(f".{stem}.npy"), array)
    return path
