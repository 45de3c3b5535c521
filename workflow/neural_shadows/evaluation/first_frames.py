"""The frames that people look at: the first view of each set by every method, with its scores."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files.whole_files import whole_file
from neural_shadows.scenes.cameras import VIEW_SETS


@dataclass
class FirstFrame:
    """A viewpoint by every method: 8-bit grey `images` (H, W), and `scores` by metric."""

    caption: str
    images: dict[str, np.ndarray] = field(default_factory=dict)
    scores: dict[str, dict[str, float]] = field(default_factory=dict)


def write_first_frames(pictures_npz: Path, method: str, images: Mapping[str, np.ndarray]) -> None:
    """Write one method's grey images (H, W) in [0, 1] by view set, as 8-bit arrays `SET.METHOD`."""
    arrays = {
        f"{view_set}.{method}": np.round(255 * image).astype(np.uint8)
        for view_set, image in images.items()
    }
    with whole_file(pictures_npz) as part:
        np.savez_compressed(part, **arrays)


def read_first_frames(pictures: Sequence[Path], metrics: Sequence[Path]) -> list[FirstFrame]:
    """Join what a scene's methods made of the first view of each view set.

    Args:
        pictures: of the first batch by the reference and by methods, as `write_first_frames`
            wrote them; the images are in this order.
        metrics: the same methods' metrics.

    Raises:
        InputError: a file cannot be read.
    """
    frames: dict[str, FirstFrame] = {}
    for path in pictures:
        for key, image in _read_arrays(path).items():
            view_set, _, method = key.partition(".")
            frame = frames.setdefault(view_set, FirstFrame(VIEW_SETS[view_set]))
            frame.images[method] = image
    values = read_metrics(metrics)
    values = values[values["view"] == values["view"].min()]
    for (view_set, method), group in values.groupby(["view_set", "method"], sort=False):
        frames[view_set].scores[method] = dict(zip(group["metric"], group["value"]))
    return list(frames.values())


def _read_arrays(path: Path) -> dict[str, np.ndarray]:
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            return dict(arrays)
    except Exception as error:  # whatever a damaged archive makes zipfile and zlib raise
        raise InputError(f"{path}: damaged ({error}); delete it and run again") from error
