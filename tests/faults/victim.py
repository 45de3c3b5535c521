"""A checkout whose runs are interrupted, and what was hit."""

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from signal import SIGINT, SIGKILL, SIGTERM, Signals

import pandas as pd
from checkout import Checkout
from same_results import differences, results_of
from started import Job, Started, rules_of
from undisturbed import TIMEOUT_S, Undisturbed

SIGNS = (SIGKILL, SIGTERM, SIGINT)

# Waits for the moment to interrupt a run; False if the run comes to its end before.
Moment = Callable[[Started], bool]


@dataclass(frozen=True)
class Interruption:
    """What a signal hit."""

    sign: Signals
    hit: Sequence[str]
    """Rules of the jobs that were running."""
    lost: Sequence[float]
    """Seconds of each training that was running since its last saved state, or its start."""
    wrong: Sequence[str]
    """Results that had their final name and were not whole."""


class Victim:
    """A checkout whose runs are interrupted."""

    def __init__(self, undisturbed: Undisturbed, checkout: Checkout):
        self.undisturbed, self.checkout = undisturbed, checkout
        self.interruptions: list[Interruption] = []
        self._whole = results_of(undisturbed.checkout)

    @cached_property
    def _files(self) -> dict[str, dict[str, list[str]]]:
        """Files of each job as targets, by rule and log, of which each job has its own."""
        rules = {}
        targets, overlays = self.undisturbed.targets, self.undisturbed.overlays
        for row in self.undisturbed.checkout.summary(*targets, overlays=overlays):
            files = rules.setdefault(row["rule"], {}).setdefault(row["log-file(s)"], [])
            files.append(row["output_file"])
        return rules

    @property
    def hit(self) -> set[str]:
        """Rules of the jobs that were hit so far."""
        return {rule for each in self.interruptions for rule in each.hit}

    def interrupt(
        self, sign: Signals, moment: Moment, *targets: str, work: Sequence[str] = ()
    ) -> bool:
        """Start a run, send all its processes a signal at a moment, and note what that hit.

        Then the folder must not be locked, except by SIGKILL, and is unlocked.

        Returns:
            False if the run came to its end before the moment, as runs should.
        """
        overlays = self.undisturbed.overlays
        targets = targets or self.undisturbed.targets
        arguments = *targets, "--rerun-incomplete", *work
        output = self.undisturbed.folder / "interrupted.txt"
        with Started(self.checkout, *arguments, overlays=overlays, output=output) as run:
            hit = run.interrupt(sign) if moment(run) else []
            now = time.time()
        if run.status == 0 and not hit:
            return False
        assert run.status != 0, run.said
        lost = [now - self._last_saved(job) for job in hit if job.rule == "train"]
        found = results_of(self.checkout)
        wrong = differences(found, {name: self._whole.get(name) for name in found})
        self.interruptions.append(Interruption(sign, rules_of(hit), lost, wrong))
        if any(self.checkout.folder.glob(".snakemake/locks/*.lock")):
            assert sign == SIGKILL, f"locked after {sign.name}:\n{run.said}"
            self.checkout.run("--unlock", overlays=overlays)
        return True

    def work_for(self, rule: str) -> list[str]:
        """Arguments that let a job of a rule run: one with a file that is not there, if any has.

        A forced job's old files go when it is interrupted. Then Snakemake does not make them again
        by itself if all that is made from them is there.
        """
        jobs = list(self._files[rule].values())
        return ["--forcerun", next(filter(self._lacking, jobs), jobs[0])[0]]

    def missing(self) -> list[str]:
        """Files of all jobs that are not there."""
        jobs = [job for jobs in self._files.values() for job in jobs.values()]
        return [name for job in jobs for name in self._lacking(job)]

    def _lacking(self, names: Sequence[str]) -> list[str]:
        return [name for name in names if not (self.checkout.folder / name).exists()]

    def in_job(self, rule: str, share: float) -> Moment:
        """After a share of the time of the rule's longest job."""

        def moment(run: Started) -> bool:
            if not run.watch(lambda jobs: rule in rules_of(jobs), TIMEOUT_S):
                return False
            end = time.time() + share * self.undisturbed.longest[rule]
            # A job that is done by then is not hit, but what follows it: there may be nothing
            # more by the end of its time.
            return run.wait(
                lambda: time.time() >= end or rule not in rules_of(run.jobs()), TIMEOUT_S, 0.01
            )

        return moment

    def in_write(self, rule: str) -> Moment:
        """As soon as a file of the rule is written; where that is not seen, soon afterwards."""

        def moment(run: Started) -> bool:
            before = self._parts(rule)
            if not run.watch(lambda jobs: rule in rules_of(jobs), TIMEOUT_S):
                return False
            end = time.time() + 2 * self.undisturbed.longest[rule]
            return run.wait(
                lambda: (
                    self._parts(rule) - before
                    or time.time() >= end
                    or rule not in rules_of(run.jobs())
                ),
                TIMEOUT_S,
            )

        return moment

    def state(self, experiment: str) -> Path | None:
        """The saved state of a training, if there is one."""
        unfinished = self.checkout.results / "networks" / "unfinished"
        return next(unfinished.glob(f"{experiment}-*/state.safetensors"), None)

    def _parts(self, rule: str) -> set[Path]:
        """Temporary files beside a rule's own."""
        names = [name for files in self._files[rule].values() for name in files]
        folders = {(self.checkout.folder / name).parent for name in names}
        return {part for folder in folders for part in folder.glob(".*.part*")}

    def _last_saved(self, job: Job) -> float:
        """When a training's last state was saved or, if none was, it was started."""
        state = self.state(job.log.stem) if job.log else None
        return max(job.started, state.stat().st_mtime if state else 0)


def at(seconds: float) -> Moment:
    """Some seconds after the start, whatever runs then."""
    return lambda run: run.wait(lambda: time.time() >= run.begun + seconds, TIMEOUT_S, 0.01)


def write_tables(interruptions: Sequence[Interruption], folder: Path, name: str) -> None:
    """Print what was hit, by stage, and write that and a row for each interruption as CSV."""
    stages = []
    for rule in sorted({rule for each in interruptions for rule in each.hit}):
        here = [each for each in interruptions if rule in each.hit]
        signs = [each.sign for each in here]
        survived = sum(not each.wrong for each in here)
        row = {"stage": rule, "interrupted": len(here), "survived": survived}
        stages.append(row | {sign.name: signs.count(sign) for sign in SIGNS})
    rows = [
        {
            "signal": each.sign.name,
            "hit": " ".join(each.hit),
            "training_seconds_lost": " ".join(f"{seconds:.1f}" for seconds in each.lost),
            "not_whole": " ".join(each.wrong),
        }
        for each in interruptions
    ]
    folder.mkdir(parents=True, exist_ok=True)
    pd.DataFrame(stages).to_csv(folder / f"{name}_by_stage.csv", index=False)
    pd.DataFrame(rows).to_csv(folder / f"{name}.csv", index=False)

    print(f"\n{pd.DataFrame(stages).to_string(index=False)}")
    signs = [each.sign for each in interruptions]
    print(", ".join(f"{signs.count(sign)} {sign.name}" for sign in SIGNS), end="; ")
    print(f"{sum(not each.hit for each in interruptions)} while no job was running")
    if lost := [seconds for each in interruptions for seconds in each.lost]:
        print(
            f"seconds lost in {len(lost)} trainings that were hit: "
            f"median {statistics.median(lost):.1f}, most {max(lost):.1f}"
        )
