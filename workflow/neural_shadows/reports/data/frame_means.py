"""Means of errors over frames, with 95 % intervals."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from neural_shadows.metrics.intervals import FEWEST_SCENES, kinds_of, scenes_interval
from neural_shadows.reports.data.table import with_ends

OFF_EDGES = "mse_off_edges"
ABOUT_EDGES = (
    "Off edges: of pixels in which all eight sample points see one surface. Errors of other pixels "
    "are mostly of antialiasing: the exact shadow at pixel centres has them, too."
)
ERROR_COLUMNS = (*with_ends("mse"), *with_ends(OFF_EDGES))


def mean_with_interval(values: pd.Series, name: str) -> dict[str, float]:
    """`name`, `name_low` and `name_high`: the mean over scenes of frames, see `scenes_interval`.

    The ends are NaN where there are too few frames for an interval, all three without a value.

    Args:
        values: a value a frame, with its `scene` in the index.
    """
    values = values.dropna()
    if values.empty:
        return dict.fromkeys(with_ends(name), np.nan)
    scenes = values.index.get_level_values("scene").to_numpy()
    mean, *ends, _ = scenes_interval(values.to_numpy()[None], scenes)
    low, high = (end if np.isfinite(end) else np.nan for end in ends)
    return dict(zip(with_ends(name), (mean, low, high)))


def squared_errors(errors: pd.DataFrame, name: str = "mse") -> dict[str, float]:
    """`mean_with_interval` over frames of squared errors: of all pixels, and off edges.

    Args:
        errors: rows of a method, of `read_metrics`.

    Returns: `name` and `NAME_off_edges` with the ends of their intervals.
    """
    return mean_with_interval(by_frame(errors, "mse"), name) | mean_with_interval(
        by_frame(errors, OFF_EDGES), f"{name}_off_edges"
    )


def mean_over_scenes(values: pd.Series) -> float:
    """Mean over scenes of their frames' means; NaN of none. `values` as of `mean_with_interval`."""
    return float(values.groupby(level="scene").mean().mean())


def by_frame(errors: pd.DataFrame, metric: str) -> pd.Series:
    """A metric of each frame, averaged over its lights.

    Args:
        errors: rows of a method, of `read_metrics`.
    """
    values = errors[errors["metric"] == metric]
    return values.groupby(["scene", "part", "frame"])["value"].mean()


def count_scenes(scenes: Sequence[str]) -> str:
    """Count scenes in words, and their kinds if these are fewer."""
    kinds = len(set(kinds_of(scenes)))
    return f"{len(scenes)} scenes" + (f" of {kinds} kinds" if kinds < len(scenes) else "")


def describe_units(scenes: Sequence[str], frames: int) -> str:
    """Describe the sample of an interval over `frames` frames in all."""
    count = len(scenes)
    if len(set(kinds_of(scenes))) >= FEWEST_SCENES:
        return f"95 % over {count_scenes(scenes)}, by Student's t of their means, of equal weight"
    if count == 1:
        return f"95 % over {frames} frames of one scene, {scenes[0]}; not valid for others"
    return f"95 % over {frames} frames in {count} scenes, {', '.join(scenes)}; not valid for others"


def describe_sample(errors: pd.DataFrame) -> str:
    """`describe_units` of test frames; `errors`: rows of `read_metrics`."""
    frames = by_frame(errors, "mse")
    return describe_units([*frames.index.unique("scene")], len(frames))


def with_shown_errors(table: pd.DataFrame) -> tuple[pd.DataFrame, str]:
    """Add errors off edges if measured, else of all pixels.

    Args:
        table: with `ERROR_COLUMNS`; of a user's own frames, without geometry, all off edges are NaN.

    Returns: the table with `error`, `error_low` and `error_high`, and their name.
    """
    off_edges = table[OFF_EDGES].notna().any()
    shown = table[with_ends(OFF_EDGES if off_edges else "mse")].set_axis(with_ends("error"), axis=1)
    return table.assign(**shown), "MSE off edges" if off_edges else "MSE"
