"""Soft shadows side by side: frames by light radius and method."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.evaluation.soft_answers import name_of, read_answer
from neural_shadows.evaluation.soft_registry import is_network, look_of
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.reports.data.frame_errors import graded_layer
from neural_shadows.reports.data.frames import Frame
from neural_shadows.reports.data.inputs import by_folder
from neural_shadows.reports.data.lights import light_names
from neural_shadows.reports.data.method_look import REFERENCE
from neural_shadows.reports.page.frame_comparison import REFERENCE_NAME, comparison, errs_least

RULE = (
    "Of soft shadows the first test frame of a scene is shown, whatever its errors: the visibility of "
    "each pixel. MSE is the mean squared error of visibility in this frame; tables have that of all "
    "test frames."
)
NUMBER = 0  # of a part's frames, the one whose answers are kept


def soft_comparisons(
    parts: Sequence[Path], answers: Sequence[Path], pictures: Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """Data for the page's script: frames and errors by table.

    A method's picture under one light takes 40 to 65 KB of the page at 512 × 256.

    Args:
        parts: of frame sets, see `FrameSetPart`; answers: of methods, in folders of frame sets.
        pictures: of scenes: `table` and its `title`, `frame_set`,
            `scene`, `labels` of methods, and `radii`, counted from 0.

    Raises:
        InputError: a file is not whole.
    """
    scenes = {(one.parent.parent.name, one.parent.name): one for one in parts}
    answered = by_folder(answers)
    frames: dict[str, list[Frame]] = {}
    labels: dict[str, str] = {}
    for one in pictures:
        frame_set = one["frame_set"]
        if part := scenes.get((frame_set, one["scene"])):
            labels |= one["labels"]
            files = {path.stem: path for path in answered.get(frame_set, ())}
            files = {method: files[method] for method in one["labels"] if method in files}
            frames.setdefault(one["table"], []).extend(_frames(part, files, one["radii"]))
    names = {method: _name(method, label) for method, label in labels.items()}
    names[REFERENCE] = REFERENCE_NAME
    titles = {one["table"]: one["title"] for one in pictures}
    networks = list(filter(is_network, labels))
    comparisons = []
    for table, shown in frames.items():
        left = errs_least(shown, "mse", networks)
        # The prefix tells a table from a scene of the same name.
        data = comparison(f"soft-{table}", titles[table], shown, names, left, _layers)
        comparisons.append(data | {"rule": RULE, "flip": False})
    return comparisons


def _frames(part: Path, answers: Mapping[str, Path], radii: Sequence[int]) -> list[Frame]:
    """The first frame of a part by methods, under each light."""
    opened = FrameSetPart(part)
    scene, lights = part.parent.name, light_names(opened.about)
    valid = np.asarray(opened.valid[NUMBER, 0])
    frames = []
    for k in radii:
        target = opened.targets[NUMBER, k].astype(np.float32)
        frame = Frame((scene, k), f"{scene}, {lights[k]}", {REFERENCE: target})
        for method, path in answers.items():
            image = np.where(valid, read_answer(path, name_of(part, k)), target)
            frame.images[method] = image
            square = np.square(image - target)[valid].mean()
            frame.scores[method] = {"mse": 1e4 * float(square)}
        frames.append(frame)
    return frames


def _layers(image: np.ndarray, reference: np.ndarray) -> dict[str, Image.Image]:
    return {"errors": Image.fromarray(graded_layer(image, reference))}


def _name(method: str, label: str) -> str:
    return f"{look_of(method).symbol} {label}"
