"""A frame under lights of several sizes: exact, and by methods."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.answers import name_of, read_answer
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.rendering.soft_shading import Shading, soft_shading
from neural_shadows.reports.data.lights import light_names

NUMBER = 0  # of a part's frames, the one whose answers are kept
SHADED = ("z", "c_e", "n_y")  # channels of a shading


@dataclass(frozen=True, eq=False)
class SoftPictures:
    """Visibility of a frame by light, exact and by methods.

    Images are (lights, height, width) float32 in [0, 1].
    """

    lights: Sequence[str]  # names
    exact: np.ndarray | None  # None of a user's frame without targets
    answers: Mapping[str, np.ndarray]  # by method; the exact one in pixels that are not valid
    valid: np.ndarray  # (height, width) bool, evaluated pixels
    smooth: np.ndarray  # likewise, off the geometry's edges where these are known
    shading: Shading | None  # None of a user's frame without its channels

    def shown(self, visibility: np.ndarray) -> np.ndarray:
        """The picture of a visibility (height, width): shaded, or itself."""
        return self.shading.picture(visibility) if self.shading else visibility

    def error(self, method: str, light: int) -> np.ndarray:
        """Visibility minus the exact one, (height, width); 0 in pixels that are not valid."""
        return self.answers[method][light] - self.exact[light]

    def mse(self, method: str, light: int) -> float:
        """Mean squared error over the valid pixels."""
        return float(np.square(self.error(method, light)[self.valid]).mean())


def read_pictures(
    frames_json: Path, answers: Mapping[str, Path], radii: Sequence[int]
) -> SoftPictures:
    """Read a part's first frame by methods under some of its lights.

    Args:
        frames_json: of the part. answers: of methods, see `write_answers`. radii: counted from 0.

    Raises:
        InputError: a file is not whole.
    """
    part = FrameSetPart(frames_json)
    names = light_names(part.about)
    images = {
        method: np.stack([read_answer(path, name_of(frames_json, k)) for k in radii])
        for method, path in answers.items()
    }
    exact = part.targets[NUMBER, list(radii)].astype(np.float32)
    return pictures_of(part, NUMBER, [names[k] for k in radii], exact, images)


def pictures_of(
    part: FrameSetPart,
    number: int,
    lights: Sequence[str],
    exact: np.ndarray | None,
    answers: Mapping[str, np.ndarray],
) -> SoftPictures:
    """Join a frame of a part with answers, see `SoftPictures`."""
    valid = np.asarray(part.valid[number, 0])
    smooth = valid if part.edges is None else valid & ~part.edges[number]
    if exact is not None:
        answers = {method: np.where(valid, images, exact) for method, images in answers.items()}
    shading = None
    if {*SHADED} <= {*part.about["channels"]}:
        z, cosine, upward = (part.image(number, channel) for channel in SHADED)
        shading = soft_shading(z > 0, cosine, upward)
    return SoftPictures(lights, exact, answers, valid, smooth, shading)
