"""The workflow on a real Slurm: killed jobs and daemons, time limits and too little memory.

    apt-get install slurm-wlm munge; pip install -r envs/slurm.txt
    pytest tests/cluster

As root, for half an hour.
"""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from checkout import SMOKE, Checkout
from same_results import differences, reports_of, results_of, take_measured
from slurm import Job, Slurm, missing, wait_for

WEIGHTS = "results/smoke/networks/dragon/weights.safetensors"

# The profile as it is, but for what this small cluster needs: it has no accounting, and its jobs
# last seconds at the smoke scale.
PROFILE = [
    *("--workflow-profile", "workflow/profiles/slurm"),
    *("--slurm-status-command", "squeue"),
    *("--slurm-init-seconds-before-status-checks", "2"),
    *("--configfile", str(SMOKE)),
]


@pytest.fixture(scope="session")
def slurm(tmp_path_factory) -> Iterator[Slurm]:
    if lacking := missing():
        pytest.skip(f"missing: {', '.join(lacking)}")
    # Started in the background, pytest and all its children would ignore Ctrl-C.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    cluster = Slurm(tmp_path_factory.mktemp("slurm"))
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()
        signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="session")
def local(slurm, tmp_path_factory) -> Checkout:
    """The smoke workflow, run to its end on this machine, without Slurm."""
    checkout = Checkout.fresh(tmp_path_factory.mktemp("local"))
    checkout.run()
    return checkout


class Submitted:
    """Snakemake at work in a checkout through the profile, with its jobs on the cluster."""

    def __init__(self, slurm: Slurm, checkout: Checkout, *arguments: str):
        self.slurm, self._output = slurm, checkout.folder / "output.txt"
        self.before = {job.id for job in slurm.queue()}
        command = [sys.executable, "-m", "snakemake", *arguments, *PROFILE]
        with self._output.open("w") as file:
            self.process = subprocess.Popen(
                command,
                cwd=checkout.folder,
                env=checkout.environment() | slurm.environment,
                stdout=file,
                stderr=subprocess.STDOUT,
            )

    def __enter__(self) -> "Submitted":
        return self

    def __exit__(self, *_) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
            self.slurm.ask("scancel", "--me")

    @property
    def output(self) -> str:
        """All that Snakemake has said."""
        return self._output.read_text()

    def jobs(self) -> list[Job]:
        """Its jobs, also those that have ended."""
        return [job for job in self.slurm.queue() if job.id not in self.before]

    def state_of(self, job: Job) -> str:
        """What has become of a job."""
        return next(other.state for other in self.jobs() if other.id == job.id)

    def working(self, rule: str) -> tuple[Job, int]:
        """Wait for a job of a rule that computes; it, and the process of its script."""
        deadline = time.monotonic() + 1800
        while self.process.poll() is None and time.monotonic() < deadline:
            for job in self.jobs():
                if job.state == "RUNNING" and job.name.startswith(f"rule_{rule}"):
                    for pid in filter(_is_script, self.slurm.processes_of(job.id)):
                        return job, pid
            time.sleep(0.1)
        raise AssertionError(f"no job of {rule} works:\n{self.output}")

    def wait(self) -> None:
        """Wait for the end of the run, which must be a good one."""
        assert self.process.wait(3600) == 0, self.output


def _is_script(pid: int) -> bool:
    try:
        return b"/.snakemake/scripts/" in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


def slow_down(checkout: Checkout, seconds: float) -> None:
    """Have a training rest so long after each of its 200 steps; its weights stay the same."""
    train = checkout.module("training/train.py")
    source = train.read_text()
    slow = source.replace("check_learning(name,", f"time.sleep({seconds}); check_learning(name,")
    assert slow != source
    train.write_text(slow)


def test_killed_jobs(slurm, local, tmp_path):
    checkout = Checkout.fresh(tmp_path / "checkout")
    with Submitted(slurm, checkout) as run:
        job, _ = run.working("train")
        slurm.ask("scancel", job.id)
        wait_for(lambda: run.state_of(job) == "CANCELLED", "end of the job")
        for rule in ("train", "evaluate"):
            _, script = run.working(rule)
            os.kill(script, signal.SIGKILL)
        run.wait()
    assert differences(results_of(checkout), results_of(local)) == []
    # Reports show measured values: those of the cluster's run, put into the local one.
    copy = local.copy(tmp_path / "same measured values")
    take_measured(checkout, copy)
    copy.run()
    assert differences(reports_of(checkout), reports_of(copy)) == []
    assert run.output.count("Trying to restart job") == 3
    assert set(re.findall(r"/group_([a-z]+)_", run.output)) == {"prepare", "rays", "reports"}
    # Each job has a log of its own. Small ones are submitted together.
    count = run.output.count("has been submitted with SLURM jobid")
    assert count < len({row["log-file(s)"] for row in local.summary()}) * 2 / 3


def test_training_goes_on_after_its_time_limit(slurm, local, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    # At least 200 s of training on any machine, in jobs of two minutes; a state is saved each
    # half minute.
    slow_down(checkout, 1)
    limits = ["--set-resources", "train:runtime=2", "train:gpu=1"]
    with Submitted(slurm, checkout, WEIGHTS, *limits) as run:
        _, script = run.working("train")
        # Reserved; there is none, so that the network is computed on the CPU all the same.
        assert b"CUDA_VISIBLE_DEVICES=0" in Path(f"/proc/{script}/environ").read_bytes()
        run.wait()
        states = [job.state for job in run.jobs()]
    log = (checkout.results / "logs" / "train" / "dragon.log").read_text()
    assert int(re.search(r"train dragon: +(\d+) ?%", log)[1]) >= 10
    assert set(states[:-1]) == {"TIMEOUT"} and states[-1] == "COMPLETED"
    assert (checkout.folder / WEIGHTS).read_bytes() == (local.folder / WEIGHTS).read_bytes()


def test_snakemake_itself_is_interrupted_and_killed(slurm, local, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    slow_down(checkout, 0.1)
    with Submitted(slurm, checkout, WEIGHTS) as run:
        job, _ = run.working("train")
        run.process.send_signal(signal.SIGINT)
        assert run.process.wait(120) != 0
        wait_for(lambda: run.state_of(job) == "CANCELLED", "end of the job")
    with Submitted(slurm, checkout, WEIGHTS) as run:
        job, _ = run.working("train")
        run.process.kill()
        run.process.wait()
        assert run.state_of(job) == "RUNNING"
        # As the profile's README says.
        listed = slurm.ask("squeue", "--me", "-h", "--format=%i %j").splitlines()
        assert [line.split()[0] for line in listed if "shadows_" in line] == [job.id]
        slurm.ask("scancel", job.id)
        wait_for(lambda: run.state_of(job) == "CANCELLED", "end of the job")
    checkout.run("--unlock")
    with Submitted(slurm, checkout, WEIGHTS) as run:
        run.wait()
    assert (checkout.folder / WEIGHTS).read_bytes() == (local.folder / WEIGHTS).read_bytes()


def test_too_little_memory_is_tried_with_more(slurm, local, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    target = "results/smoke/rays/dragon/uniform/directions.npy"
    memory = ["--set-resources", "draw_directions:mem_mb=150 * attempt"]
    with Submitted(slurm, checkout, target, "--forcerun", target, *memory) as run:
        run.wait()
        states = [job.state for job in run.jobs()]
    assert len(states) > 1 and set(states[:-1]) == {"FAILED"} and states[-1] == "COMPLETED"
    assert "memory limit" in (slurm.folder / "slurmd.log").read_text()
    assert differences(results_of(checkout), results_of(local)) == []
