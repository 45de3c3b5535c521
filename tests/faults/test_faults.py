"""Killed in any stage, on one core or on a full disk: the same command ends in the same bytes.

    pytest tests/faults

Not part of `pytest` alone: half an hour on two cores.
"""

import random
import re
import shutil
import signal
from dataclasses import dataclass, replace
from pathlib import Path
from signal import SIGINT, SIGKILL, SIGTERM

import pytest
from checkout import ROOT, Checkout, write_overlay
from processes import Moment, after, interrupt, resize, small_disk, writes
from same_results import differences, leavings_of, reports_of, results_of, take_measured

# What `all` makes, and what is only made on request.
WHOLE = [
    "all",
    "reports/smoke/cost.csv",
    "reports/smoke/figure_cost.png",
    "results/smoke/networks/dragon_field/network.onnx",
]

# A training that saves several checkpoints, one a second.
LONG = "dragon_long"
LONG_WEIGHTS = f"results/smoke/networks/{LONG}/weights.safetensors"
STEPS = 4000

# Each stage is killed while its first file is written, and sent one of the others before that.
SIGNALS = {"writes": [SIGKILL], "works": [SIGTERM, SIGINT]}

RULES = Checkout(ROOT).run("--quiet", "all", "--list-rules").split()


@dataclass(frozen=True)
class Undisturbed:
    """A finished run with which all others are compared."""

    start: Checkout
    """The checkout before the run."""
    finished: Checkout
    """The checkout after it; it must be left as it is."""
    overlays: list[Path]
    place: Path
    """Where runs are disturbed, and this one was: numba keeps kernels by their source's path."""

    def again(self) -> Checkout:
        """The finished run, to disturb."""
        self.place.mkdir(exist_ok=True)
        for path in self.place.iterdir():  # it may be a disk of its own
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        return self.finished.copy(self.place)

    def files_of(self, rule: str) -> list[str]:
        """The files of one of the rule's jobs, as targets."""
        rows = self.finished.summary(*WHOLE, overlays=self.overlays)
        jobs = [row["log-file(s)"] for row in rows if row["rule"] == rule]
        return [row["output_file"] for row in rows if jobs and row["log-file(s)"] == jobs[0]]

    def wrong(self, run: Checkout) -> list[str]:
        """Results of another run that have their name and are not as they should be."""
        found, whole = results_of(run), results_of(self.finished)
        return differences(found, {name: whole.get(name) for name in found})

    def differences(self, run: Checkout) -> list[str]:
        """Files in which another finished run differs, but for what it measured."""
        return differences(results_of(run), results_of(self.finished)) + differences(
            reports_of(run), reports_of(self.finished)
        )


@pytest.fixture(scope="session", autouse=True)
def interruptible():
    """Started in the background, pytest and all its children would ignore Ctrl-C."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory) -> Undisturbed:
    folder = tmp_path_factory.mktemp("undisturbed")
    start = Checkout.fresh(folder / "start")
    train = start.module("training/train.py")
    source = train.read_text(encoding="utf-8")
    often = source.replace("CHECKPOINT_SECONDS = 30.0", "CHECKPOINT_SECONDS = 1.0")
    assert often != source
    train.write_text(often, encoding="utf-8")
    experiment = {"scene": "dragon", "sampling": "poisson_quadtree", "network": "thesis"}
    overlay = write_overlay(
        folder / "long.yaml",
        trainings={"long": {"steps": STEPS, "batch_size": 1024, "learning_rate": 1e-4}},
        experiments={LONG: experiment | {"training": "long"}},
    )
    run = start.copy(folder / "a checkout")
    run.run(*WHOLE, LONG_WEIGHTS, overlays=[overlay])
    assert leavings_of(run) == []
    return Undisturbed(start, run.copy(folder / "finished"), [overlay], run.folder)


@pytest.mark.parametrize("when", SIGNALS)
@pytest.mark.parametrize("rule", RULES)
def test_killed(undisturbed, rule, when):
    targets = undisturbed.files_of(rule)
    if not targets:
        pytest.skip("no job of it at the smoke scale")
    seed = RULES.index(rule)
    sign = SIGNALS[when][seed % len(SIGNALS[when])]
    # Most jobs take longer. One that does not is sent its signal at once.
    for seconds in (random.Random(seed).uniform(0, 3), 0):
        checkout = undisturbed.again()
        files = [checkout.folder / name for name in targets]
        for file in files:
            file.unlink()
        moment: Moment = writes(files) if when == "writes" else after(seconds)
        if interrupt(checkout, targets, sign, moment, overlays=undisturbed.overlays):
            break
    else:
        pytest.fail("no run could be interrupted")
    assert undisturbed.wrong(checkout) == []
    checkout.run(*targets, overlays=undisturbed.overlays)
    assert undisturbed.differences(checkout) == []


def test_a_training_continues_from_its_checkpoint(undisturbed):
    checkout = undisturbed.again()
    shutil.rmtree(checkout.results / "networks" / LONG)

    def progress() -> list[float]:
        """When checkpoints were saved."""
        found = checkout.results.glob(f"networks/*/{LONG}-*/state.safetensors")
        return [path.stat().st_mtime for path in found]

    for sign in (SIGKILL, SIGTERM, SIGINT):
        before = progress()
        assert interrupt(
            checkout,
            [LONG_WEIGHTS],
            sign,
            lambda group, before=before: progress() not in ([], before),
            overlays=undisturbed.overlays,
        )
    checkout.run(LONG_WEIGHTS, overlays=undisturbed.overlays)
    log = (checkout.results / "logs" / "train" / f"{LONG}.log").read_text(encoding="utf-8")
    # Where the last of the jobs began.
    assert int(re.search(rf"train {LONG}: +(\d+) ?%", log)[1]) > 0
    assert undisturbed.differences(checkout) == []


def test_one_core_in_another_path(undisturbed, tmp_path):
    checkout = replace(undisturbed.start.copy(tmp_path / "another"), cores=1)
    targets, overlays = [*WHOLE, LONG_WEIGHTS], undisturbed.overlays
    checkout.run(*targets, overlays=overlays)
    assert leavings_of(checkout) == []
    assert differences(results_of(checkout), results_of(undisturbed.finished)) == []
    # What reports show of measured values cannot be the same: take this run's.
    copy = undisturbed.again()
    take_measured(checkout, copy)
    copy.run(*targets, overlays=overlays)
    assert differences(reports_of(checkout), reports_of(copy)) == []


def test_disk_that_fills(undisturbed):
    overlays = undisturbed.overlays
    written = sum(path.lstat().st_size for path in undisturbed.finished.folder.rglob("*"))
    undisturbed.again()  # so that there is a folder to mount on
    with small_disk(undisturbed.place, 4 * written):
        checkout = undisturbed.again()
        shutil.rmtree(checkout.results / "evaluations")
        shutil.rmtree(checkout.reports)
        used = shutil.disk_usage(undisturbed.place).used
        resize(undisturbed.place, used + 300_000)
        failed = checkout.snakemake(*WHOLE, overlays=overlays)
        assert failed.returncode != 0
        assert "No space left on device" in failed.stdout, failed.stdout
        assert undisturbed.wrong(checkout) == []
        resize(undisturbed.place, 4 * written)
        checkout.run(*WHOLE, overlays=overlays)
        assert undisturbed.differences(checkout) == []
