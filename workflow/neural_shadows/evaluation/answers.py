"""Methods' visibilities of frames, on disk for figures.

One npz file of arrays by name, uint8, visibility in steps of 1/255: fine enough for an 8-bit picture.
Of a view by its number in a batch, its m points on the lit side (m,): a batch of 24 frames of 600 × 400
takes 66 kB, of PCF 180 kB; its G-buffers, see `References`, are the same for all methods. Of the first
frame of each part of a frame set `SCENE.PART.RADIUS` (height, width); of each sequence
`SCENE.PART.flicker`, by how much a pixel changes from frame to frame on average, and
`SCENE.PART.flicker_exact`, the same of the exact shadow.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file

if TYPE_CHECKING:
    from neural_shadows.rendering.gbuffer import GBuffer

STEPS = 255


def name_of(part: Path, radius: int) -> str:
    """Name of a part's first frame; a part is `SCENE/PART.json`."""
    return f"{part.parent.name}.{part.stem}.{radius}"


def flicker_name(part: Path, exact: bool = False) -> str:
    """Name of a sequence's map of changes, or the exact shadow's."""
    return f"{part.parent.name}.{part.stem}.flicker{'_exact' * exact}"


def write_answers(path: Path, answers: Mapping[str, np.ndarray]) -> None:
    """Write visibilities in [0, 1] by name."""
    steps = {name: np.round(STEPS * shares).astype(np.uint8) for name, shares in answers.items()}
    with whole_file(path) as part:
        np.savez_compressed(part, **steps)


def read_answer(path: Path, name: str) -> np.ndarray:
    """Visibilities float32 by their name.

    Raises:
        InputError: the file is missing, damaged, or has no such name.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            return arrays[name] / np.float32(STEPS)
    except Exception as error:  # zipfile and zlib raise many kinds
        raise InputError(f"{path}: damaged ({error}). Delete it and run again.") from error


def read_view(path: Path, number: int, frame: "GBuffer") -> np.ndarray:
    """Visibility (n,) float32 of a view of a batch.

    Raises:
        InputError: the file is missing, damaged, or not of this view.
    """
    answer = read_answer(path, str(number))
    if answer.shape != frame.lit_side.shape:
        raise InputError(f"{path}: damaged (of another view). Delete it and run again.")
    return frame.visibility(answer)
