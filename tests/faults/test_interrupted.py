"""Killed in every stage, on one core, in another path or on a full disk: the same bytes.

    pytest tests/faults

Not part of `pytest` alone: 10 minutes on two cores.
"""

import itertools
import shutil
import signal
from dataclasses import replace
from pathlib import Path

import pytest
from checkout import Checkout
from few_jobs import TARGETS, few_jobs, files_of_rules, rules_of
from processes import interrupt, resize, small_disk
from same_results import differences, differing_reports, leavings_of, reports_of, results_of

from neural_shadows.networks.weight_file import load_tensors

SIGNALS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]


@pytest.fixture(scope="session")
def overlays(tmp_path_factory) -> list[Path]:
    # Long enough for several checkpoints, one a second.
    return [few_jobs(tmp_path_factory.mktemp("overlays") / "few.yaml", steps=4000)]


@pytest.fixture(scope="session")
def start(tmp_path_factory) -> Checkout:
    """A checkout in which nothing has run."""
    # Started in the background, pytest and all its children would ignore Ctrl-C.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    checkout = Checkout.fresh(tmp_path_factory.mktemp("start"))
    steps = checkout.module("training/steps.py")
    source = steps.read_text(encoding="utf-8")
    often = source.replace("CHECKPOINT_SECONDS = 30.0", "CHECKPOINT_SECONDS = 1.0")
    assert often != source
    steps.write_text(often, encoding="utf-8")
    return checkout


@pytest.fixture(scope="session")
def finished(start, overlays, tmp_path_factory) -> Checkout:
    """A run without a disturbance, with which others are compared; it must be left as it is."""
    checkout = start.copy(tmp_path_factory.mktemp("finished") / "a checkout")
    checkout.run(*TARGETS, overlays=overlays)
    assert leavings_of(checkout) == []
    return checkout


def wrong(checkout: Checkout, wanted: dict[str, bytes]) -> list[str]:
    """Results of an unfinished run that have their name and are not as they should be."""
    return [name for name, content in results_of(checkout).items() if content != wanted.get(name)]


def writings_of(folder: Path, patterns: list[str]) -> set[tuple[Path, int]]:
    """The files that are there, whole or in part, and when each was last written."""
    found = set()
    for pattern in patterns:
        whole = folder / pattern
        for path in whole.parent.parent.glob(f"{whole.parent.name}/*{whole.name}*"):
            try:
                found.add((path, path.stat().st_mtime_ns))
            except FileNotFoundError:
                pass  # a part that has just become whole
    return found


def test_killed_in_every_stage(start, finished, overlays, tmp_path):
    """One run, on one core, that a signal ends once in each rule and thrice while it trains."""
    checkout = replace(start.copy(tmp_path / "another"), cores=1)
    watched = files_of_rules(finished, overlays)
    assert watched.keys() == rules_of(finished)
    # Written when the state beside it is whole.
    curve = "results/smoke/networks/checkpoints/dragon-*/loss.csv"
    watched |= {f"checkpoint {number}": [curve] for number in (1, 2, 3)}
    wanted, trained = results_of(finished), []
    for sign in itertools.cycle(SIGNALS):
        before = {rule: writings_of(checkout.folder, files) for rule, files in watched.items()}
        seen: list[str] = []

        def is_time(before=before, seen=seen) -> bool:
            seen += [
                rule
                for rule, files in watched.items()
                if writings_of(checkout.folder, files) - before[rule]
            ]
            return bool(seen)

        if not interrupt(checkout, TARGETS, sign, is_time, overlays):
            break
        print(f"{sign.name}: {seen[0]}")
        del watched[seen[0]]
        assert wrong(checkout, wanted) == []
        if "checkpoint" in seen[0]:
            (state,) = checkout.results.glob("networks/checkpoints/dragon-*/state.safetensors")
            trained.append(load_tensors(state)[1]["seconds"])
    assert watched == {}
    # Each went on where the one before was ended, for a second.
    assert all(seconds > number for number, seconds in enumerate(trained, start=1)), trained
    assert leavings_of(checkout) == []
    assert differences(results_of(checkout), wanted) == []
    copy = tmp_path / "same measured values"
    assert differing_reports(checkout, finished, copy, *TARGETS, overlays=overlays) == []


def test_disk_that_fills(finished, overlays, tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    written = sum(path.lstat().st_size for path in finished.folder.rglob("*"))
    with small_disk(disk, 4 * written):
        checkout = finished.copy(disk)
        shutil.rmtree(checkout.results / "evaluations")
        shutil.rmtree(checkout.reports)
        wanted = results_of(finished)
        resize(disk, shutil.disk_usage(disk).used + 1_500_000)
        failed = checkout.snakemake(*TARGETS, overlays=overlays)
        assert failed.returncode != 0
        # Mostly of a job's file, with what to do: tests/unit/running/test_stage.py. Where the jobs'
        # files just had room, of Snakemake's own script.
        assert "No space left on device" in failed.stdout, failed.stdout
        assert wrong(checkout, wanted) == []
        resize(disk, 4 * written)
        checkout.run(*TARGETS, overlays=overlays)
        assert differences(results_of(checkout), wanted) == []
        assert differences(reports_of(checkout), reports_of(finished)) == []
