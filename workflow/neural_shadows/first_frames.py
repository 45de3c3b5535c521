"""The frames that people look at: the first view of each set by every method, with its scores."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from neural_shadows.broken import broken
from neural_shadows.tables import read_metrics

CAPTIONS = {
    "shadow": "aimed at the cast shadow",
    "surface": "aimed at the object's surface (self-shadowing)",
    "centre": "aimed at the object's centre",
}


@dataclass
class FirstFrame:
    """A viewpoint by every method: 8-bit grey `images` (H, W), and `scores` by metric."""

    caption: str
    images: dict[str, np.ndarray] = field(default_factory=dict)
    scores: dict[str, dict[str, float]] = field(default_factory=dict)


def read_first_frames(pictures: Sequence[Path], metrics: Sequence[Path]) -> list[FirstFrame]:
    """Join what evaluations of one scene rendered of the first view of each view set.

    Args:
        pictures: frames as `evaluate` wrote them, one file for each evaluation and view set.
        metrics: the metrics of the same batches, in the same order.

    Raises:
        InputError: a file is missing; or not whole, and moved aside.
    """
    frames: dict[str, FirstFrame] = {}
    for picture_path, metrics_path in zip(pictures, metrics, strict=True):
        values = read_metrics([metrics_path])
        values = values[values["view"] == values["view"].iloc[0]]
        view_set = values["view_set"].iloc[0]
        frame = frames.setdefault(view_set, FirstFrame(CAPTIONS[view_set]))
        try:
            # Opened here: np.load leaves its own file open where the archive is cut short.
            with picture_path.open("rb") as file, np.load(file, allow_pickle=False) as images:
                frame.images |= dict(images)
        except (OSError, ValueError, EOFError, BadZipFile) as error:
            reason = " ".join(str(error).split())
            raise broken(picture_path, f"not a whole file of frames ({reason})") from error
        frame.scores |= {
            method: dict(zip(group["metric"], group["value"]))
            for method, group in values.groupby("method")
        }
    return list(frames.values())
