"""Trainings by method, budget and seed, and their errors."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from neural_shadows.metrics.registry import error_of
from neural_shadows.settings.records import CurvePoint, MeshReport, Row, TrainingRecord

THESIS_SAMPLES = 1_000_000 * 65_536  # steps of batches [4.1]
LOSS_SHARE = 0.1  # the end of a loss curve


@dataclass(frozen=True)
class Budget:
    """Trainings of the same length.

    `runs` has of each experiment those of the same seeds, in their order. `samples` is None, and
    there are no runs, if no method of a comparison is trained.
    """

    samples: int | None
    runs: Mapping[str, Sequence[str]]

    @property
    def seeds(self) -> int:
        """Trainings of each experiment; 1 if none is trained."""
        return min(map(len, self.runs.values()), default=1)


@dataclass(frozen=True, kw_only=True)
class Trained:
    """Metrics, losses and trainings of networks by scene.

    Args:
        metrics: a row a view, with its view set, and a column a (method, metric), by scene.
        losses: of `read_loss`, by experiment; trainings: training.json, by experiment.
        meshes: mesh.json, by scene.
        curves: the points of each learning curve: `experiment`, `samples` and `seed` each.
        seed: of the resampling of views.
    """

    metrics: Mapping[str, pd.DataFrame]
    losses: Mapping[str, pd.DataFrame]
    trainings: Mapping[str, TrainingRecord]
    meshes: Mapping[str, MeshReport]
    curves: Mapping[str, Sequence[CurvePoint]]
    seed: int

    def budgets(self, rows: Iterable[Row]) -> list[Budget]:
        """The budgets of methods in growing order.

        At each all trained methods among the rows share a seed. One without samples if no method is
        trained; none where `unshared` has a reason.
        """
        arms = {row["experiment"]: {} for row in rows if row["trained"]}
        if not arms:
            return [Budget(None, {})]
        for name, arm in arms.items():
            for point in self._points(name):
                arm.setdefault(point["samples"], {})[point["seed"]] = point["experiment"]
        shared = []
        for samples in sorted(set.intersection(*map(set, arms.values()))):
            seeds = sorted(set.intersection(*(set(arm[samples]) for arm in arms.values())))
            runs = {name: [arm[samples][s] for s in seeds] for name, arm in arms.items()}
            shared += [Budget(samples, runs)] * bool(seeds)
        return shared

    def unshared(self, rows: Sequence[Row]) -> str:
        """The reason for no common budget; empty with one."""
        if self.budgets(rows):
            return ""
        trained = [self._points(row["experiment"]) for row in rows if row["trained"]]
        most = [max(point["samples"] for point in points) for points in trained]
        if len(set(most)) == 1:
            return "trained from no common seed"
        return f"trained on {' and '.join(f'{samples:,}' for samples in most)} samples"

    def diverged(self, row: Row, budgets: Iterable[Budget]) -> bool:
        """Check for diverged trainings of a method."""
        runs = [run for budget in budgets for run in budget.runs.get(row["experiment"], ())]
        return any(self.trainings[run]["died_at_step"] is not None for run in runs)

    def methods(self, row: Row, budget: Budget) -> list[str]:
        """The keys of a method's trainings, or its own."""
        name, method = row["experiment"], row["method"]
        if name not in budget.runs:
            return [method] * budget.seeds
        bias = method.removeprefix(name)  # the end of a biased key
        return [run + bias for run in budget.runs[name]]

    def metric(self, row: Row, metric: str) -> str:
        """The metric, or FLIP for LPIPS without its backbone."""
        measured = self.metrics[row["scene"]].columns.get_level_values(1)
        return "flip" if metric == "lpips" and metric not in measured else metric

    def errors(self, row: Row, metric: str, budget: Budget) -> pd.DataFrame:
        """Errors of a method by view and training.

        LPIPS, FLIP and shares as they are, PSNR as the squared error (peak 1), SSIM as 1 − SSIM.
        """
        frames, methods = self.metrics[row["scene"]], self.methods(row, budget)
        values = pd.concat([frames[method, metric] for method in methods], axis=1)
        return values.apply(lambda each: error_of(metric, each))

    def end_losses(self, row: Row, budget: Budget) -> np.ndarray:
        """The end losses of each training (S,).

        Each is the mean of the last tenth. Of a diverged one at least that of drawing no shadow: its
        loss before is of lost weights.
        """
        return np.array([self._end_loss(run) for run in budget.runs[row["experiment"]]])

    def _end_loss(self, run: str) -> float:
        loss, record = self.losses[run]["loss"].to_numpy(), self.trainings[run]
        end = loss[-max(1, round(LOSS_SHARE * len(loss))) :]
        if record["died_at_step"] is None:
            return float(end.mean())
        finite = len(end) and np.isfinite(end).all()
        return float(max(end.mean() if finite else 0.0, record["no_shadow_loss"]))

    def _points(self, experiment: str) -> Sequence[CurvePoint]:
        """The trainings of an experiment's curve, or its own."""
        if points := self.curves.get(experiment):
            return points
        # The planned length, also of a diverged training.
        training = self.trainings[experiment]["training"]
        samples = training["steps"] * training["batch_size"]
        return [{"experiment": experiment, "samples": samples, "seed": training["seed"]}]
