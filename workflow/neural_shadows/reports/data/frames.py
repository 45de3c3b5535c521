"""Pictures of viewpoints by the reference and by every method."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.evaluation.answers import read_view
from neural_shadows.evaluation.references import References
from neural_shadows.rendering.shading import shade
from neural_shadows.reports.data.method_look import REFERENCE
from neural_shadows.scenes.cameras import VIEW_SETS

View = tuple[str, int]  # a view set and a number in it


@dataclass
class Frame:
    """A viewpoint by `reference` and by methods: grey `images` (H, W) float32 in [0, 1].

    `caption` names the view; `scores` are by method and metric.
    """

    view: View
    caption: str
    images: dict[str, np.ndarray]
    scores: dict[str, dict[str, float]] = field(default_factory=dict)


def read_frames(
    references: Sequence[Path],
    visibilities: Sequence[Path],
    metrics: pd.DataFrame,
    views: Sequence[View],
) -> list[Frame]:
    """Read views of a scene by methods with both visibility and metrics.

    Args:
        references: batches of the scene, as BATCH.safetensors; visibilities: of its methods, as
            SCENE.BATCH/METHOD.npz, in the order of the images.
        metrics: of the methods, of `read_view_metrics`.

    Raises:
        InputError: a file cannot be read.
    """
    scores = metrics.pivot(index=["view_set", "view", "method"], columns="metric", values="value")
    counts = metrics.groupby("view_set")["view"].nunique()
    frames = {}
    for path in references:
        batch = References(path)
        group = f"{path.parent.name}.{path.stem}"
        answered = {file.stem: file for file in visibilities if file.parent.name == group}
        for number, view in enumerate((v.view_set, v.index) for v in batch.views):
            if view not in views:
                continue
            frame, truth = batch[number]
            picture = Frame(view, _caption(view, counts[view[0]]), {REFERENCE: shade(frame, truth)})
            for method, file in answered.items():
                if (*view, method) in scores.index:
                    visibility = read_view(file, number, frame)
                    picture.images[method] = shade(frame, visibility)
                    picture.scores[method] = scores.loc[*view, method].dropna().to_dict()
            frames[view] = picture
    return [frames[view] for view in views if view in frames]


def _caption(view: View, count: int) -> str:
    """Number of the view from 1, as viewers have it, and the aim of its camera."""
    view_set, number = view
    return f"View {number + 1} of {count}, {VIEW_SETS[view_set]}"
