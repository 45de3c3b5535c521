"""Killed in any stage, the same command finishes with the results of an undisturbed run."""

import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from checkout import Checkout

TARGET = "reports/smoke/table_4_3.csv"

# Files of each stage that the target needs, below results/smoke.
STAGES = {
    "sample_rays": "rays/dragon/poisson_quadtree/origins.*.npy",
    "label_rays": "rays/dragon/poisson_quadtree/bounds.*.npy",
    "train": "networks/dragon/weights.safetensors",
    "evaluate": "evaluations/dragon/*.csv",
}

# Hold times and the machine.
TIMED = {"logs", "benchmarks"}
TIMED_FILES = {"training.json"}


@pytest.fixture(autouse=True)
def interruptible():
    """Started in the background, pytest and all its children would ignore Ctrl-C."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def results_of(checkout: Checkout) -> dict[str, bytes]:
    """Content of every result of the target that does not hold times, by its path."""
    found = {TARGET: (checkout.folder / TARGET).read_bytes()}
    folders = {Path(pattern).parent for pattern in STAGES.values()}
    for path in (path for folder in folders for path in (checkout.results / folder).iterdir()):
        name = path.relative_to(checkout.results)
        # What SIGKILL cuts short keeps its temporary, hidden name.
        if path.is_file() and name.parts[0] not in TIMED and not name.name.startswith("."):
            found[str(name)] = path.read_bytes()
    return {name: data for name, data in found.items() if Path(name).name not in TIMED_FILES}


def interrupt(checkout: Checkout, stage: str, sign: signal.Signals, output: Path) -> None:
    """Start the workflow and send `sign` to all its processes as soon as a job of `stage` works."""
    logs = checkout.results / "logs" / stage
    shutil.rmtree(logs, ignore_errors=True)
    with output.open("w") as file:
        process = subprocess.Popen(
            checkout.command(TARGET, "--rerun-incomplete"),
            cwd=checkout.folder,
            env=checkout.environment(),
            stdout=file,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            started = time.monotonic()
            # The first that a job says is its progress bar, just before the work.
            while not any(log.stat().st_size for log in logs.glob("*.log")):
                assert process.poll() is None, output.read_text()
                assert time.monotonic() - started < 300, output.read_text()
                time.sleep(0.01)
            os.killpg(process.pid, sign)
            process.wait(60)
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
    assert process.returncode != 0


def test_interrupted_in_each_stage(smoke, tmp_path):
    checkout = smoke.copy(tmp_path / "checkout")
    for folder in ("rays", "networks", "evaluations"):
        shutil.rmtree(checkout.results / folder)
    for path in checkout.reports.glob("table_*"):
        path.unlink()
    undisturbed = results_of(smoke)

    for stage, sign in (
        ("sample_rays", signal.SIGKILL),
        ("label_rays", signal.SIGKILL),
        ("train", signal.SIGINT),
        ("train", signal.SIGKILL),
        ("evaluate", signal.SIGKILL),
    ):
        interrupt(checkout, stage, sign, tmp_path / "output.txt")
        wanted = {path.relative_to(smoke.results) for path in smoke.results.glob(STAGES[stage])}
        made = {path for path in wanted if (checkout.results / path).exists()}
        assert made < wanted, f"{stage} was over before it was interrupted"
        for path in made:
            assert (checkout.results / path).read_bytes() == undisturbed[str(path)], path
        # After Ctrl-C Snakemake unlocks the folder itself.
        if sign == signal.SIGKILL:
            checkout.run("--unlock")

    checkout.run(TARGET, "--rerun-incomplete")
    results = results_of(checkout)
    assert results.keys() == undisturbed.keys()
    assert [name for name in results if results[name] != undisturbed[name]] == []
