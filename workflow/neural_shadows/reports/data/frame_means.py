"""Means of errors over frames, with 95 % intervals."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from neural_shadows.metrics.intervals import FEWEST_SCENES, scenes_interval

OFF_EDGES = "mse_off_edges"
ABOUT_EDGES = (
    "Off edges: of pixels in which all eight sample points see one surface. Errors of other pixels "
    "are mostly of antialiasing: the exact shadow at pixel centres has them, too."
)


def mean_with_interval(values: pd.Series, name: str) -> dict[str, float]:
    """`name`, `name_low` and `name_high`: the mean over scenes of frames, see `scenes_interval`.

    The ends are NaN where there are too few frames for an interval, all three without a value.

    Args:
        values: a value a frame, with its `scene` in the index.
    """
    values = values.dropna()
    if values.empty:
        return dict.fromkeys((name, f"{name}_low", f"{name}_high"), np.nan)
    scenes = values.index.get_level_values("scene").to_numpy()
    mean, *ends, _ = scenes_interval(values.to_numpy()[None], scenes)
    low, high = (end if np.isfinite(end) else np.nan for end in ends)
    return {name: mean, f"{name}_low": low, f"{name}_high": high}


def mean_over_scenes(values: pd.Series) -> float:
    """Mean over scenes of their frames' means; NaN of none. `values` as of `mean_with_interval`."""
    return float(values.groupby(level="scene").mean().mean())


def by_frame(errors: pd.DataFrame, metric: str) -> pd.Series:
    """A metric of each frame, averaged over its lights.

    Args:
        errors: rows of a method, of `read_soft_metrics`.
    """
    values = errors[errors["metric"] == metric]
    return values.groupby(["scene", "part", "frame"])["value"].mean()


def describe_units(scenes: Sequence[str], frames: int) -> str:
    """Describe the sample of an interval over `frames` frames in all."""
    count = len(scenes)
    if count >= FEWEST_SCENES:
        return f"95 % over {count} scenes, by Student's t of their means, of equal weight"
    if count == 1:
        return f"95 % over {frames} frames of one scene, {scenes[0]}; not valid for others"
    return f"95 % over {frames} frames in {count} scenes, {', '.join(scenes)}; not valid for others"
