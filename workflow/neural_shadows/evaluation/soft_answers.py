"""Soft-shadow methods' images of test frames, on disk for figures.

One npz file: of the first frame of each part `SCENE.PART.RADIUS` (height, width) uint8, visibility in
steps of 1/255; of each sequence `SCENE.PART.flicker`, by how much a pixel changes from frame to frame
on average, and `SCENE.PART.flicker_exact`, the same of the exact shadow.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file


def name_of(part: Path, radius: int) -> str:
    """Key of a part's first frame; a part is `SCENE/PART.json`."""
    return f"{part.parent.name}.{part.stem}.{radius}"


def flicker_name(part: Path, exact: bool = False) -> str:
    """Key of a sequence's map of changes, or the exact shadow's."""
    return f"{part.parent.name}.{part.stem}.flicker{'_exact' * exact}"


def write_answers(path: Path, answers: Mapping[str, np.ndarray]) -> None:
    """Write visibilities (height, width) in [0, 1] by name."""
    steps = {name: np.round(255 * image).astype(np.uint8) for name, image in answers.items()}
    with whole_file(path) as part:
        np.savez_compressed(part, **steps)


def read_answer(path: Path, name: str) -> np.ndarray:
    """Visibility (height, width) float32 of a frame by its name.

    Raises:
        InputError: the file is missing, damaged, or not of this frame.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            return arrays[name] / np.float32(255)
    except Exception as error:  # zipfile and zlib raise many kinds
        raise InputError(f"{path}: damaged ({error}). Delete it and run again.") from error
