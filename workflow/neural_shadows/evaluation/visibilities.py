"""A method's visibilities of a batch, on disk for figures.

One npz file: of each frame by number, `NUMBER` (m,) uint8, the visibility of its m points on the
lit side in steps of 1/255: fine enough for an 8-bit picture of PCF. A batch of 24 frames of
600 × 400 takes 66 kB, of PCF 180 kB; reading a frame takes 5 ms. Its G-buffers, see `References`,
are the same for all methods.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file
from neural_shadows.rendering.gbuffer import GBuffer

STEPS = 255


def write_visibilities(path: Path, lit: Sequence[np.ndarray]) -> None:
    """Write visibilities (m,) of lit sides, in [0, 1], in order."""
    steps = {str(i): np.round(STEPS * shares).astype(np.uint8) for i, shares in enumerate(lit)}
    with whole_file(path) as part:
        np.savez_compressed(part, **steps)


def read_visibility(path: Path, number: int, frame: GBuffer) -> np.ndarray:
    """Visibility (n,) float32 of a frame of the batch.

    Raises:
        InputError: the file is missing, damaged, or not of this frame.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            return frame.visibility(arrays[str(number)] / np.float32(STEPS))
    except Exception as error:  # zipfile and zlib raise many kinds
        raise InputError(f"{path}: damaged ({error}). Delete it and run again.") from error
