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
COUNTS = "counts"


def name_of(part: Path, radius: int) -> str:
    """Name of a part's first frame; a part is `SCENE/PART.json`."""
    return f"{part.parent.name}.{part.stem}.{radius}"


def flicker_name(part: Path, exact: bool = False) -> str:
    """Name of a sequence's map of changes, or the exact shadow's."""
    return f"{part.parent.name}.{part.stem}.flicker{'_exact' * exact}"


def write_answers(
    path: Path, answers: Mapping[str, np.ndarray], counts: np.ndarray | None = None
) -> None:
    """Write visibilities in [0, 1] by name.

    Args:
        counts: of violations, (frames, 7) int64, a row of `Violations` for each view.
    """
    steps = {name: np.round(STEPS * shares).astype(np.uint8) for name, shares in answers.items()}
    if counts is not None:
        steps[COUNTS] = counts
    with whole_file(path) as part:
        np.savez_compressed(part, **steps)


def read_answer(path: Path, name: str) -> np.ndarray:
    """Visibilities float32 by their name.

    Raises:
        InputError: the file is missing, damaged, or has no such name.
    """
    return _read(path, name) / np.float32(STEPS)


def read_view(path: Path, number: int, frame: "GBuffer") -> np.ndarray:
    """Visibility (n,) float32 of a view of a batch.

    Raises:
        InputError: the file is missing, damaged, or not of this view.
    """
    answer = read_answer(path, str(number))
    if answer.shape != frame.lit_side.shape:
        raise InputError(f"{path}: damaged (of another view). Delete it and run again.")
    return frame.visibility(answer)


def read_counts(path: Path) -> np.ndarray | None:
    """Counts of `write_answers`; None without.

    Raises:
        InputError: the file is missing or damaged.
    """
    return _read(path, COUNTS, optional=True)


def _read(path: Path, name: str, optional: bool = False) -> np.ndarray | None:
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            return None if optional and name not in arrays else arrays[name]
    except Exception as error:  # zipfile and zlib raise many kinds
        raise InputError(f"{path}: damaged ({error}). Delete it and run again.") from error
