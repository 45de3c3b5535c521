"""Soft shadows of a made scene by methods whose errors are known, as the page is given them."""

from pathlib import Path

import numpy as np
from screen_frames import edge, write_frames

from neural_shadows.evaluation.answers import name_of, write_answers

LABELS = {"hard": "Shadow map", "rt_4": "4 rays", "my_network": "Network"}
SHIFTS = {
    "hard": -1,
    "rt_4": 0,
    "my_network": 2,
}  # pixels of the edge to the right, from light to dark
SCENES = ("room", "tree")


def seen(method: str, radius: int) -> np.ndarray:
    """What a method answers; the margin, which does not count, is dark."""
    answer = edge(24 + SHIFTS[method], soft=4.0 * radius)
    answer[:, :2] = 0
    return answer


def write_soft_pictures(folder: Path) -> dict[str, list]:
    """Frames of two scenes under two lights, what methods answered, and what to show of them."""
    parts = [write_frames(folder / "wall" / scene, "test") for scene in SCENES]
    paths = [folder / "evaluations" / "wall" / "all" / f"{method}.npz" for method in LABELS]
    paths[0].parent.mkdir(parents=True)
    for path in paths:
        radii = {name_of(part, k): seen(path.stem, k) for part in parts for k in (0, 1)}
        write_answers(path, radii)
    shown = {"table": "rivals", "title": "A wall", "frame_set": "wall", "labels": LABELS}
    pictures = [shown | {"scene": scene, "radii": [0, 1]} for scene in SCENES]
    return {"soft_parts": parts, "soft_answers": paths, "soft_pictures": pictures}
