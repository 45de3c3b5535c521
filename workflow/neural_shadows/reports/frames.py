"""Viewpoints as the reference and every method show them, drawn anew from what they answered."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.visibilities import read_visibility
from neural_shadows.rendering.shading import shade
from neural_shadows.scenes.cameras import VIEW_SETS

REFERENCE = "reference"
View = tuple[str, int]  # a view set and a number in it


@dataclass
class Frame:
    """A viewpoint by `reference` and by methods: grey `images` (H, W) float32 in [0, 1].

    `scores` are by method and metric; the view is one of `count` of its set.
    """

    view: View
    count: int
    images: dict[str, np.ndarray]
    scores: dict[str, dict[str, float]] = field(default_factory=dict)

    @property
    def caption(self) -> str:
        """Which view it is, and where the camera is aimed."""
        view_set, number = self.view
        return f"View {number} (of 0 to {self.count - 1}), {VIEW_SETS[view_set]}"


def read_frames(
    references: Sequence[Path],
    visibilities: Sequence[Path],
    metrics: pd.DataFrame,
    views: Sequence[View],
) -> list[Frame]:
    """Some views of a scene, in their order.

    Args:
        references: batches of the scene, as BATCH.safetensors; visibilities: of its methods, as
            METHOD.BATCH.npz, whose order the images have.
        metrics: of the methods, as `read_metrics` gives them.

    Raises:
        InputError: a file cannot be read.
    """
    scores = metrics.pivot(index=["view_set", "view", "method"], columns="metric", values="value")
    counts = metrics.groupby("view_set")["view"].nunique()
    frames = {}
    for path in references:
        batch = References(path)
        methods = {}
        for one in visibilities:
            method, _, name = one.stem.rpartition(".")
            if name == path.stem:
                methods[method] = one
        for number, seen in enumerate(batch.views):
            view = (seen.view_set, seen.index)
            if view not in views:
                continue
            frame, truth = batch[number]
            answers = {
                method: read_visibility(one, number, frame) for method, one in methods.items()
            }
            images = {
                name: shade(frame, one) for name, one in ({REFERENCE: truth} | answers).items()
            }
            found = {
                m: scores.loc[*view, m].dropna().to_dict()
                for m in methods
                if (*view, m) in scores.index
            }
            frames[view] = Frame(view, counts[view[0]], images, found)
    return [frames[view] for view in views if view in frames]
