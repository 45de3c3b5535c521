"""The measurements behind claims."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.reports.data.trained import THESIS_SAMPLES, Row, Trained
from neural_shadows.settings.records import FrameTimes, SceneInfo, TrainingRecord

# Training samples of networks by text: rays of the thesis, pixels of the papers. Own claims are about
# methods without training, or about networks as they are: their statements name the training.
TEXT_SAMPLES = {
    "thesis": THESIS_SAMPLES,
    "nsm": 75 * 400 * 2048 * 1024,  # epochs of up to 400 images [4]
    # Steps of two images; the rate falls last at 40,000, and its end is not printed [5, code].
    "kpnsm": 40_000 * 2 * 2048 * 1024,
    "own": float("nan"),
}
Claim = Mapping[str, Any]  # resolved, with the keys of its kind's `Settings`
NO_SHADOW_ROW = {
    "method": NO_SHADOW,
    "label": "No shadow",
    "experiment": None,
    "trained": False,
    "bias": None,
}


@dataclass(frozen=True, kw_only=True)
class Measured(Trained):
    """All measured values.

    Args:
        times: of `time_methods`, by table and scene.
        published: the thesis's numbers as config/published.csv has them; margins: of each metric
            the difference between the thesis's own trainings.
        scenes: `procedural` marks stand-ins made to the thesis's description.
        soft: of each table of soft methods its per-frame metrics, labels and times.
        tables: CSVs of tables, by name; screen_trainings: training.json of screen-space networks.
    """

    times: Mapping[tuple[str, str], FrameTimes]
    scenes: Mapping[str, SceneInfo]
    published: pd.DataFrame
    margins: Mapping[str, float]
    soft: Mapping[str, Any] = field(default_factory=dict)
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    screen_trainings: Mapping[str, TrainingRecord] = field(default_factory=dict)

    def pixels(self, claim: Claim) -> int | None:
        """The fewest training pixels of screen-space networks, if any."""
        records = [self.screen_trainings.get(name, {}) for name in trained_screen_networks(claim)]
        return min((record["samples"] for record in records if "samples" in record), default=None)


def labels(rows: Sequence[Row]) -> list[str]:
    """Labels of compared methods, with scenes if these differ."""
    if len({row["scene"] for row in rows}) == 1:
        return [row["label"] for row in rows]
    return [f"{row['label']} ({row['scene']})" for row in rows]


def trained_screen_networks(claim: Claim) -> list[str]:
    """A claim's trained screen-space networks, each once."""
    return [*dict.fromkeys(claim.get("networks") or [])]


def needs(claim: Claim, name: str) -> Any:
    """A claim's need by its name in `Needs`, if any."""
    return (claim.get("needs") or {}).get(name)
