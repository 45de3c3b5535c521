"""Methods for soft shadows on a frame set, with notes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.evaluation.metric_files import read_metrics
from neural_shadows.evaluation.registry import LABELS, UNLEARNED
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.data.inputs import read_by_folder
from neural_shadows.reports.data.lights import light_names, radii_of, unit_of
from neural_shadows.settings.records import PartRecord, TrainingRecord

ABOUT_NULLS = (
    "The CSV also has rows of null predictors (no shadow, all dark, the light map as it is), "
    "named in `null`. A claim that also holds of them is vacuous."
)


@dataclass(frozen=True, kw_only=True)
class SoftFrames:
    """Methods evaluated on the test frames of a frame set.

    Args:
        soft_metrics: of each method. labels: by method, in the table's order.
        screen_trainings: training.json of the networks.
        frames_json: a part of the frames. widths_json: of `measure_frames`, for a note; None for
            frames without targets.
    """

    soft_metrics: list[Path]
    screen_trainings: list[Path]
    labels: Mapping[str, str]
    frames_json: Path
    widths_json: Path | None = None

    @cached_property
    def errors(self) -> pd.DataFrame:
        """Rows of `read_metrics`."""
        return read_metrics(self.soft_metrics)

    @cached_property
    def records(self) -> dict[str, TrainingRecord]:
        """Trainings by experiment."""
        return read_by_folder(self.screen_trainings)

    @cached_property
    def about(self) -> PartRecord:
        """JSON of the part."""
        return read_json(self.frames_json)

    @property
    def radii(self) -> list[float]:
        """Radii of the lights, in `unit`."""
        return radii_of(self.about)

    @property
    def unit(self) -> str:
        """Unit of the radii, see `unit_of`."""
        return unit_of(self.about)

    @property
    def lights(self) -> list[str]:
        """Names of the lights, by radius."""
        return light_names(self.about)

    def describe_widths(self, scenes: Sequence[str] | None = None) -> list[str]:
        """Describe penumbra widths by light: median and 90th percentile.

        Each is the median over `scenes`, of the former also the least and the most. Nothing of a light
        without extent, whose penumbrae are the antialiasing's, or without a file.

        Args:
            scenes: of the table; without them all of the frame set.
        """
        if self.widths_json is None:
            return []
        record = read_json(self.widths_json)
        scenes = [*record["scenes"]] if scenes is None else scenes
        parts = []
        for k, (light, radius) in enumerate(zip(light_names(record), record["radii"])):
            widths = [record["scenes"][scene][k] for scene in scenes if record["scenes"][scene][k]]
            if not radius or not widths:
                continue
            medians, wide = np.array(widths).T
            ends = f"{medians.min():.0f} to {medians.max():.0f}"
            parts.append(f"{light} {np.median(medians):.0f} ({ends}) and {np.median(wide):.0f}")
        return parts and [
            "Exact widths of penumbrae in pixels, median and 90th percentile over a scene's penumbra "
            f"pixels, of {len(scenes)} scenes the median (least to most): {'; '.join(parts)}. Wider "
            f"ones count as {record['widest']}."
        ]


@dataclass(frozen=True, kw_only=True)
class TrainedFrames(SoftFrames):
    """Screen-space networks and null predictors on test frames.

    Args:
        null_metrics: of the null predictors.
    """

    null_metrics: list[Path]

    @cached_property
    def errors(self) -> pd.DataFrame:
        """Rows of `read_metrics`; empty without any file."""
        paths = [*self.soft_metrics, *self.null_metrics]
        return read_metrics(paths) if paths else pd.DataFrame({"method": []})

    def of_scenes(self, scenes: Sequence[str]) -> "TrainedFrames":
        """The same of some scenes' frames."""
        errors = self.errors
        part = replace(self)
        vars(part)["errors"] = errors[errors["scene"].isin(scenes)] if len(errors) else errors
        return part

    @property
    def nulls(self) -> dict[str, str]:
        """Labels of the measured null predictors."""
        measured = set(self.errors["method"])
        return {method: LABELS[method] for method in UNLEARNED if method in measured}

    @property
    def labels_and_nulls(self) -> dict[str, str]:
        """Labels of the methods, and of other null predictors."""
        return dict(self.labels) | self.nulls

    def null_of(self, method: str) -> str | None:
        """The method if it is an unlisted null predictor."""
        return None if method in self.labels else method

    def notes(self) -> list[str]:
        """Notes on null predictors, trainings and penumbra widths."""
        return [
            ABOUT_NULLS,
            *describe_trainings(self.records, self.labels),
            *self.describe_widths(),
        ]


def learned_rows(table: pd.DataFrame) -> pd.DataFrame:
    """The table without null predictors."""
    return table[table["null"].isna()] if "null" in table else table


def describe_trainings(
    records: Mapping[str, TrainingRecord], labels: Mapping[str, str]
) -> list[str]:
    """Describe trainings, equal ones together, and name diverged ones.

    Those of shipped weights are told apart from the run's own.
    """
    names_by_text: dict[str, list[str]] = {}
    diverged = [
        f"{labels.get(name, name)} at step {record['died_at_step']}"
        for name, record in records.items()
        if record["died_at_step"] is not None
    ]
    for name, record in records.items():
        training = record["training"]
        begins = f" from {training['perturbation_from']:.0%} of them on"
        begin = "Weights as shipped, of" if "shipped" in record else "Trained for"
        text = (
            f"{begin} {training['steps']:,} steps of {training['crops']} crops of {training['crop']}², "
            f"{training['optimiser'].capitalize()} at {training['learning_rate']:g}, seed "
            f"{training['seed']}, perceptual term: {record['perceptual']}, perturbation's weight "
            f"{training['perturbation']:g}{begins if training['perturbation'] else ''}"
        )
        names_by_text.setdefault(text, []).append(labels.get(name, name))
    notes = [f"{text}: {', '.join(names)}." for text, names in names_by_text.items()]
    if diverged:
        notes.append(
            f"**Diverged**, with the same output for every pixel since: {', '.join(diverged)}. Such numbers "
            "do not judge the network's form. Try a lower `learning_rate` or another `seed`."
        )
    return notes
