"""A network's lit points of a batch, on disk before metrics.

One npz file: of each frame by number, `NUMBER.lit`, a bit for each point on the lit side; and
`violations` (frames, 7) int64, a row of `Violations` for each, or empty without counts.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.evaluation.violations import Violations
from neural_shadows.files.whole_files import whole_file
from neural_shadows.rendering.gbuffer import GBuffer


def write_answers(path: Path, lit: Sequence[np.ndarray], violations: Sequence[Violations]) -> None:
    """Write lit points (m,) bool and violations of each frame. Points on the lit side."""
    bits = {f"{number}.lit": np.packbits(points) for number, points in enumerate(lit)}
    with whole_file(path) as part:
        np.savez(part, violations=np.array(violations, np.int64), **bits)


class Answers:
    """A file of a network's lit points."""

    def __init__(self, path: Path):
        """Read the file.

        Raises:
            InputError: it is missing, or damaged.
        """
        try:
            with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                self._arrays = dict(arrays)
            self._violations = self._arrays["violations"]
        except Exception as error:  # zipfile and zlib raise many kinds
            raise InputError(f"{path}: damaged ({error}). Delete it and run again.") from error

    def visibility(self, number: int, frame: GBuffer) -> np.ndarray:
        """Visibility (n,) float32 of a frame of the batch, 0 or 1."""
        bits = self._arrays[f"{number}.lit"]
        return frame.visibility(np.unpackbits(bits, count=len(frame.lit_side)))

    def violations(self, number: int) -> Violations | None:
        """Violations of a frame; None without counts."""
        if len(self._violations) == 0:
            return None
        return Violations(*self._violations[number].tolist())
