"""Interrupted anywhere and started again, a run ends in the results of an undisturbed one."""

import random
import re
import shutil
import time
from collections.abc import Iterator
from pathlib import Path
from signal import SIGINT, SIGKILL, SIGTERM, Signals

import pytest
from same_results import differences, leavings_of, results_of
from started import RULE_OF, Started
from undisturbed import LONG, LONG_WEIGHTS, TIMEOUT_S
from victim import Moment, Victim, at, write_tables

from neural_shadows.networks.weight_file import load_tensors

# It needs a network. What a cut connection leaves is tested in tests/unit/test_download.py.
NEVER = {"download_mesh"}

# By then Snakemake has read the workflow and begun with jobs.
START_S = 12


def aims(
    victim: Victim, full: bool, moments: random.Random
) -> Iterator[tuple[Signals, str | None, Moment]]:
    """Signals, the rules whose turn it is, and the moments.

    Rules come in the order in which an undisturbed run does. In the short form, those that were
    not hit by chance before have one signal each. In the whole, each has SIGKILL at a random moment
    and while a file is written, and one of the others; and every third is followed by two signals
    at random moments of a run. Trainings, which take longest, are hit four times more.
    """
    for number, rule in enumerate(victim.undisturbed.longest):
        if not full:
            if rule not in victim.hit:
                sign = (SIGKILL, SIGTERM, SIGINT)[len(victim.interruptions) % 3]
                # The undisturbed run compiled the kernels, which took most of the time of some jobs.
                yield sign, rule, victim.in_job(rule, moments.random() / 3)
            continue
        for _ in range(5 if rule == "train" else 1):
            yield SIGKILL, rule, victim.in_job(rule, moments.random())
        yield (SIGTERM, SIGINT)[number % 2], rule, victim.in_job(rule, moments.random())
        yield SIGKILL, rule, victim.in_write(rule)
        if number % 3 == 0:
            for sign in (SIGKILL, moments.choice((SIGTERM, SIGINT))):
                yield sign, None, at(moments.uniform(0, START_S))
    # A job that was faster than in the undisturbed run was over by its moment.
    for _ in range(3):
        for rule in victim.undisturbed.longest.keys() - victim.hit:
            yield SIGKILL, rule, victim.in_job(rule, 0)


@pytest.fixture
def tables(request, tmp_path) -> Path:
    """The folder that the tables of kills go to."""
    return request.config.getoption("--kills") or tmp_path / "kills"


def test_interrupted_in_each_stage(undisturbed, full, moments, tables):
    checkout = undisturbed.another(finished=False, compiled=not full)
    victim = Victim(undisturbed, checkout)
    try:
        for sign, rule, moment in aims(victim, full, moments):
            for _ in range(5):
                work = victim.work_for(rule) if rule is not None else ()
                if victim.interrupt(sign, moment, work=work):
                    break
                # The run came to its end before. One at any moment needs work of any rule.
                rule = rule or next(iter(victim.undisturbed.longest))
    finally:
        write_tables(victim.interruptions, tables, "kills")
    assert [each for each in victim.interruptions if each.wrong] == []
    assert victim.hit >= undisturbed.longest.keys()
    if full:
        assert victim.hit == {*RULE_OF.values()} - NEVER
        assert sum(each.sign == SIGKILL for each in victim.interruptions) >= 50
    undisturbed.finish(checkout, *undisturbed.targets, *victim.missing())
    undisturbed.same_as(checkout)


def test_training_continues_from_its_last_state(undisturbed, full, moments, tables):
    checkout = undisturbed.another(finished=True)
    victim = Victim(undisturbed, checkout)
    shutil.rmtree(checkout.results / "networks" / LONG)
    log = checkout.results / "logs" / "train" / f"{LONG}.log"

    def after_a_state(run: Started) -> bool:
        """At any time from when a state was saved to when the next would be."""

        def saved(_) -> bool:
            state = victim.state(LONG)
            return state is not None and state.stat().st_mtime > run.begun

        if not run.watch(saved, TIMEOUT_S):
            return False
        end = time.time() + moments.random() * undisturbed.state_interval_s
        return run.wait(lambda: time.time() >= end, TIMEOUT_S)

    steps = 0
    for sign in (SIGKILL, SIGTERM, SIGINT) if full else (SIGKILL, SIGINT):
        assert victim.interrupt(sign, after_a_state, LONG_WEIGHTS)
        assert _percent_at_first(log) == pytest.approx(100 * steps / undisturbed.steps, abs=0.6)
        _, header = load_tensors(victim.state(LONG))
        assert header["step"] > steps
        steps = header["step"]
        (lost,) = victim.interruptions[-1].lost
        assert lost <= time.time() - victim.state(LONG).stat().st_mtime
    assert all(each.hit == ["train"] for each in victim.interruptions)

    # With the network there and Snakemake about to note it, all of the training is at stake.
    weights = checkout.folder / LONG_WEIGHTS
    assert victim.interrupt(SIGKILL, lambda run: run.wait(weights.exists, TIMEOUT_S), LONG_WEIGHTS)
    write_tables(victim.interruptions, tables, "training_kills")
    assert _percent_at_first(log) == pytest.approx(100 * steps / undisturbed.steps, abs=0.6)
    undisturbed.finish(checkout, LONG_WEIGHTS)
    assert _percent_at_first(log) == 100
    assert differences(results_of(checkout), results_of(undisturbed.checkout)) == []
    assert leavings_of(checkout) == []


@pytest.mark.usefixtures("only_full")
def test_job_that_outlives_snakemake(undisturbed):
    """Two processes then make the same files, and the later of them has a state to begin with."""
    checkout = undisturbed.another(finished=True)
    shutil.rmtree(checkout.results / "networks" / LONG)
    settings = {"overlays": undisturbed.overlays, "output": undisturbed.folder / "outlived.txt"}
    with Started(checkout, LONG_WEIGHTS, **settings) as run:
        state = Victim(undisturbed, checkout).state
        assert run.watch(lambda jobs: state(LONG) is not None, TIMEOUT_S)
        (left,) = run.kill_snakemake_alone()
        checkout.run("--unlock", overlays=undisturbed.overlays)
        undisturbed.finish(checkout, LONG_WEIGHTS)
        deadline = time.monotonic() + TIMEOUT_S
        while run.jobs():
            assert time.monotonic() < deadline
            time.sleep(0.1)
    assert left.rule == "train"
    assert differences(results_of(checkout), results_of(undisturbed.checkout)) == []
    assert leavings_of(checkout) == []


def _percent_at_first(log: Path) -> float:
    """How much of its steps a training had done when it began."""
    return float(re.search(rf"train {LONG}: +(\d+)%", log.read_text(encoding="utf-8"))[1])
