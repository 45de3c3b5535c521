"""The run that nothing disturbs, with which all others are compared."""

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from checkout import Checkout, write_overlay
from same_results import differences, leavings_of, reports_of, results_of, take_measured
from started import Started

# A training of several times the 30 s between two saved states. The short form of these tests
# has a shorter one, which saves a state each second.
LONG = "dragon_long"
LONG_WEIGHTS = f"results/smoke/networks/{LONG}/weights.safetensors"

TABLE = "reports/smoke/table_4_3.csv"

# All that can be made offline: what `all` makes, what is only made on request, and the long
# training.
WHOLE = (
    "all",
    "reports/smoke/cost.csv",
    "reports/smoke/figure_cost.png",
    "results/smoke/networks/dragon_field/network.onnx",
    LONG_WEIGHTS,
)

# Has a space, so that this is tested with all else.
PLACE = "a checkout"

TIMEOUT_S = 7200
"""Of a whole run: many times what it takes, for machines that do other work as well."""


@dataclass(frozen=True)
class Undisturbed:
    """A finished run, what was asked of it, and what its jobs took."""

    folder: Path
    """Where everything is."""
    start: Checkout
    """The checkout before the run."""
    checkout: Checkout
    """The checkout after it; it must be left as it is."""
    targets: Sequence[str]
    overlays: Sequence[Path]
    steps: int
    """Of the long training."""
    state_interval_s: float
    """Seconds between two of its saved states."""
    longest: dict[str, float]
    """Seconds of the longest job of each rule, in the order of their first."""

    @classmethod
    def run(cls, folder: Path, full: bool) -> "Undisturbed":
        """Make the one table and the long training, or all."""
        start = Checkout.fresh(folder / "start")
        steps, interval = (20_000, 30.0) if full else (2_000, 1.0)
        if not full:
            for module, change in (
                ("training.py", f'train.__kwdefaults__["state_interval_s"] = {interval}'),
                # There is nothing to download from, and 7 of 13 s go into waiting for it.
                ("download.py", 'fetch.__kwdefaults__["backoff_s"] = 0.1'),
            ):
                with start.module(module).open("a", encoding="utf-8") as file:
                    file.write(f"\n{change}\n")
        experiment = {"scene": "dragon", "sampling": "poisson_quadtree", "network": "thesis"}
        overlay = write_overlay(
            folder / "long.yaml",
            trainings={"long": {"steps": steps, "batch_size": 1024, "learning_rate": 1e-4}},
            experiments={LONG: experiment | {"training": "long"}},
        )
        targets = WHOLE if full else (TABLE, LONG_WEIGHTS)
        # The whole form compares paths with and without a space. The short one spares itself to
        # compile kernels anew, 20 s, which numba keeps by the path of their source.
        checkout = start.copy(folder / ("undisturbed" if full else PLACE))
        longest = finish(checkout, *targets, overlays=[overlay], output=folder / "said.txt")
        if not full:
            checkout = checkout.copy(folder / "undisturbed")
        return cls(folder, start, checkout, targets, [overlay], steps, interval, longest)

    @property
    def place(self) -> Path:
        """Where runs are disturbed: the same for all, for their kernels."""
        return self.folder / PLACE

    def another(self, *, finished: bool, compiled: bool = True) -> Checkout:
        """A checkout to disturb: as before the run or as after it.

        Args:
            compiled: keep the kernels that earlier ones have compiled.
        """
        kernels, kept = self.place / ".snakemake" / "numba", self.folder / "kernels"
        self.place.mkdir(exist_ok=True)
        if kernels.exists():
            shutil.rmtree(kept, ignore_errors=True)
            shutil.move(kernels, kept)
        for path in self.place.iterdir():  # it may be a disk of its own
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        checkout = (self.checkout if finished else self.start).copy(self.place)
        shutil.rmtree(kernels, ignore_errors=True)
        if compiled and kept.exists():
            shutil.copytree(kept, kernels)
        return checkout

    def finish(self, checkout: Checkout, *targets: str) -> None:
        """Let a run come to its end: that of all that this one made, or of other targets."""
        output = self.folder / "finish.txt"
        finish(checkout, *(targets or self.targets), overlays=self.overlays, output=output)

    def same_as(self, run: Checkout) -> None:
        """Assert that another finished run has the same results and reports.

        What reports show of measured values cannot be the same. So its measured values are put
        into a copy of this run, which makes its reports anew from those alone.
        """
        assert leavings_of(run) == []
        assert differences(results_of(run), results_of(self.checkout)) == []
        copy = self.checkout.copy(self.folder / "same measured values")
        take_measured(run, copy)
        self.finish(copy)
        assert differences(reports_of(run), reports_of(copy)) == []
        shutil.rmtree(copy.folder)


def finish(checkout: Checkout, *targets: str, output: Path, **settings) -> dict[str, float]:
    """Run the workflow, which must come to its end; gives what the jobs took, see `Started`."""
    with Started(checkout, *targets, "--rerun-incomplete", output=output, **settings) as run:
        run.watch(lambda jobs: False, timeout=TIMEOUT_S)
        assert run.status == 0, run.said
    return run.longest
