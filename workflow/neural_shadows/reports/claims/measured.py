"""What claims are tested on: measured values by method, budget and seed."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.method_names import NO_SHADOW
from neural_shadows.metrics.error_scale import error_of

THESIS_SAMPLES = 1_000_000 * 65_536  # steps of batches [4.1]
# What a network of each text was trained on: rays of the thesis, pixels of the papers. Own claims are
# of methods that are not trained.
TEXT_SAMPLES = {
    "thesis": THESIS_SAMPLES,
    "nsm": 75 * 400 * 2048 * 1024,  # epochs of up to 400 images [4]
    # Steps of two images; the rate falls last at 40,000, and where it ends is not printed [5, code].
    "kpnsm": 40_000 * 2 * 2048 * 1024,
    "own": float("nan"),
}
LOSS_SHARE = 0.1  # of a loss curve: its end is what was reached
NO_SHADOW_ROW = {
    "method": NO_SHADOW,
    "label": "No shadow",
    "experiment": None,
    "trained": False,
    "bias": None,
}

# Kinds of claims whose methods are not those of a scene's viewpoints: printed numbers, soft shadows,
# numbers of tables.
WITHOUT_ROWS = ("printed", "soft_better", "soft_equal_time", "ratio", "proportional")

Row = Mapping[str, Any]  # as `config.rows_of` gives it


@dataclass(frozen=True)
class Budget:
    """Trainings of the same length: of each experiment those of the same seeds, in their order.

    `samples` is None, and there are no runs, if no method of a comparison is trained.
    """

    samples: int | None
    runs: Mapping[str, Sequence[str]]

    @property
    def seeds(self) -> int:
        """How many trainings there are of each experiment; 1 if none is trained."""
        return min(map(len, self.runs.values()), default=1)


@dataclass(frozen=True)
class Measured:
    """Everything that claims are tested on.

    Args:
        metrics: a row a view, with its view set, and a column a (method, metric), by scene.
        losses: of `read_loss`, by experiment; trainings: training.json, by experiment.
        times: what `measure_frame_times` wrote, by table and scene; meshes: mesh.json, by scene.
        published: the thesis's numbers as config/published.csv has them; margins: of each metric
            what the thesis's own trainings differ by.
        curves: the points of each learning curve: `experiment`, `samples` and `seed` each.
        scenes: `procedural` of each: a mesh made to the thesis's description stands in for its own.
        seed: of the resampling of views.
        soft: of each table of soft methods its per-frame metrics, labels and times.
        tables: CSVs of tables, by name; screen_trainings: training.json of networks of frames.
    """

    metrics: Mapping[str, pd.DataFrame]
    losses: Mapping[str, pd.DataFrame]
    trainings: Mapping[str, Mapping[str, Any]]
    times: Mapping[tuple[str, str], Mapping[str, Any]]
    meshes: Mapping[str, Mapping[str, Any]]
    scenes: Mapping[str, Mapping[str, Any]]
    published: pd.DataFrame
    margins: Mapping[str, float]
    curves: Mapping[str, Sequence[Mapping[str, Any]]]
    seed: int
    soft: Mapping[str, Any] = field(default_factory=dict)
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    screen_trainings: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def budgets(self, rows: Iterable[Row]) -> list[Budget]:
        """The budgets, growing, at which all trained methods among the rows share a seed.

        One without samples if no method is trained; none where `unshared` says why.
        """
        arms = {row["experiment"]: {} for row in rows if row["trained"]}
        if not arms:
            return [Budget(None, {})]
        for name, found in arms.items():
            for point in self._points(name):
                found.setdefault(point["samples"], {})[point["seed"]] = point["experiment"]
        shared = []
        for samples in sorted(set.intersection(*map(set, arms.values()))):
            seeds = sorted(set.intersection(*(set(found[samples]) for found in arms.values())))
            runs = {name: [found[samples][s] for s in seeds] for name, found in arms.items()}
            shared += [Budget(samples, runs)] * bool(seeds)
        return shared

    def unshared(self, rows: Sequence[Row]) -> str:
        """Why methods have no budget in common, at which alone they compare; empty if they have."""
        if self.budgets(rows):
            return ""
        trained = [self._points(row["experiment"]) for row in rows if row["trained"]]
        most = [max(point["samples"] for point in points) for points in trained]
        if len(set(most)) == 1:
            return "trained from no common seed"
        return f"trained on {' and '.join(f'{samples:,}' for samples in most)} samples"

    def died(self, row: Row, budgets: Iterable[Budget]) -> bool:
        """Whether a training of a method died at one of the budgets."""
        runs = [run for budget in budgets for run in budget.runs.get(row["experiment"], ())]
        return any(self.trainings[run]["died_at_step"] is not None for run in runs)

    def methods(self, row: Row, budget: Budget) -> list[str]:
        """The keys of a method's trainings at a budget; the same one for each if it has none."""
        name, method = row["experiment"], row["method"]
        if name not in budget.runs:
            return [method] * budget.seeds
        bias = method.removeprefix(name)  # the end of a key that has a bias found for it
        return [run + bias for run in budget.runs[name]]

    def metric(self, row: Row, metric: str) -> str:
        """The metric, or FLIP for LPIPS where a scene has none for want of its trunk."""
        known = self.metrics[row["scene"]].columns.get_level_values(1)
        return "flip" if metric == "lpips" and metric not in known else metric

    def errors(self, row: Row, metric: str, budget: Budget) -> pd.DataFrame:
        """Errors of a method: a row a view, with its view set, and a column a training.

        LPIPS, FLIP and shares as they are, PSNR as the squared error (peak 1), SSIM as 1 − SSIM.
        """
        found = self.metrics[row["scene"]]
        methods = self.methods(row, budget)
        values = pd.concat([found[method, metric] for method in methods], axis=1)
        return values.apply(lambda each: error_of(metric, each))

    def pixels(self, claim: Mapping[str, Any]) -> int | None:
        """The fewest pixels that one of a claim's networks of frames saw; None if it has none."""
        records = [self.screen_trainings.get(name, {}) for name in networks_of_frames(claim)]
        return min((record["samples"] for record in records if "samples" in record), default=None)

    def end_losses(self, row: Row, budget: Budget) -> np.ndarray:
        """The mean loss of the last tenth of each training (S,).

        Of a dead one at least that of drawing no shadow: the loss before it died is of a network
        that is no more.
        """
        return np.array([self._end_loss(run) for run in budget.runs[row["experiment"]]])

    def _end_loss(self, run: str) -> float:
        loss, record = self.losses[run]["loss"].to_numpy(), self.trainings[run]
        end = loss[-max(1, round(LOSS_SHARE * len(loss))) :]
        if record["died_at_step"] is None:
            return float(end.mean())
        known = len(end) and np.isfinite(end).all()
        return float(max(end.mean() if known else 0.0, record["no_shadow_loss"]))

    def _points(self, experiment: str) -> Sequence[Mapping[str, Any]]:
        """The trainings of an experiment: those of its learning curve, or its own alone."""
        if points := self.curves.get(experiment):
            return points
        # Its whole length: a training that died did not come so far, but was one of that budget.
        training = self.trainings[experiment]["training"]
        samples = training["steps"] * training["batch_size"]
        return [{"experiment": experiment, "samples": samples, "seed": training["seed"]}]


def labels(rows: Sequence[Row]) -> list[str]:
    """What reports call the methods of a comparison, with their scenes if these differ."""
    if len({row["scene"] for row in rows}) == 1:
        return [row["label"] for row in rows]
    return [f"{row['label']} ({row['scene']})" for row in rows]


def compared(claim: Mapping[str, Any]) -> list[Sequence[Row]]:
    """The methods that a claim compares with each other, or each alone; none of `WITHOUT_ROWS`."""
    if claim["kind"] in WITHOUT_ROWS:
        return []
    return [*claim.get("pairs", ()), *([row] for row in claim.get("methods", ()))]


def rows_of(claim: Mapping[str, Any]) -> list[Row]:
    """The methods of a claim; none of `WITHOUT_ROWS`."""
    return [row for rows in compared(claim) for row in rows]


def networks_of_frames(claim: Mapping[str, Any]) -> list[str]:
    """The trained networks of frames that a claim is about."""
    return [*dict.fromkeys(claim.get("networks") or [])]
