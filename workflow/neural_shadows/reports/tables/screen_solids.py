"""Errors of screen-space networks by number of occluders (NSM, figure 12)."""

from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.metrics.kinds.errors_by_occluders import MOST
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.frame_means import describe_sample, mean_with_interval
from neural_shadows.reports.data.quality_cells import metric_column
from neural_shadows.reports.data.soft_frames import TrainedFrames, learned_rows
from neural_shadows.reports.data.table import Table
from neural_shadows.sections.frame_tables import NetworksTable


class Settings(NetworksTable):
    """Networks' errors by number of solids before the light."""

    kind: Literal["screen_solids"] = Field(description="`screen_solids`")


def table(soft: TrainedFrames) -> Table:
    """Tabulate errors by network and number of solids.

    CSV: those of `solids_table`, and the scale.
    """
    lit = [number for number, radius in enumerate(soft.about["radii"]) if radius > 0]
    errors = soft.errors[soft.errors["radius"].isin(lit)]
    whole = solids_table(errors, soft)
    table = learned_rows(whole)
    more = [" and more" * (number == MOST) for number in table["solids"]]
    columns = {
        "network": table["label"],
        "solids": [f"{number}{end}" for number, end in zip(table["solids"], more)],
        metrics()["mse"].label: metric_column(table, "mse", interval=True),
        "the line": metric_column(table, "mse", "line"),
        "each solid adds": metric_column(table, "mse_per_solid", "slope", interval=True),
    }
    notes = [
        "Of pixels of test frames with so many solids between them and the light's centre, mean over "
        "all lights but a point light, which one solid hides as much as several "
        f"[{describe_sample(errors)}]. A solid: two surfaces on the ray to the light, "
        "or one of a sheet.",
        "Each solid adds: the slope of a line fitted to the squared errors of a frame's pixels over "
        "their numbers of solids, mean over frames. The line: with this slope through their means.",
        *soft.notes(),
    ]
    return Table(whole, columns, notes, text_columns=2)


def solids_table(errors: pd.DataFrame, soft: TrainedFrames) -> pd.DataFrame:
    """Tabulate errors by network or null predictor and number of solids.

    Columns: `experiment`, `label`, `null` (see `TrainedFrames.null_of`), `solids`, `mse` and
    `slope` (what each solid adds, the same in all rows of a network) with the ends of their
    intervals over frames, `line`, the error at this number on a line of this slope.
    """
    # The sample is of frames: all lights of one together.
    keys = ["method", "metric", "scene", "part", "frame"]
    frames = errors.groupby(keys)["value"].mean().dropna()
    rows = []
    for experiment, label in soft.labels_and_nulls.items():
        own = frames[experiment]
        slope = mean_with_interval(_values(own, "mse_per_solid"), "slope")
        behind, middle = (_values(own, name).mean() for name in ("mse_behind", "solids_behind"))
        for number in range(1, MOST + 1):
            row = {"experiment": experiment, "label": label, "solids": number}
            row["null"] = soft.null_of(experiment)
            row |= mean_with_interval(_values(own, f"mse_solids_{number}"), "mse")
            rows.append(row | {"line": behind + slope["slope"] * (number - middle)} | slope)
    return pd.DataFrame(rows)


def _values(own: pd.Series, metric: str) -> pd.Series:
    return own[own.index.get_level_values("metric") == metric]
