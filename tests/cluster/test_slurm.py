"""The workflow on a real Slurm: killed jobs, time limits and too little memory.

    apt-get install slurm-wlm munge; pip install -r envs/slurm.txt
    pytest tests/cluster

As root, for a quarter of an hour.
"""

import json
import os
import re
import signal
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from checkout import Checkout
from few_jobs import few_jobs
from same_results import differences, differing_reports, results_of
from slurm import Job, Slurm, missing, throw_away_slurm, wait_for

WEIGHTS = "results/smoke/networks/dragon/weights.safetensors"
DIRECTIONS = "results/smoke/rays/dragon/poisson_quadtree/directions.npy"

# The profile as it is, but for what this small cluster needs: it has no accounting, and its jobs
# last seconds at the smoke scale.
PROFILE = [
    *("--workflow-profile", "workflow/profiles/slurm"),
    *("--slurm-status-command", "squeue"),
    *("--slurm-init-seconds-before-status-checks", "2"),
]


@pytest.fixture(scope="session")
def slurm(tmp_path_factory) -> Iterator[Slurm]:
    if lacking := missing():
        pytest.skip(f"missing: {', '.join(lacking)}")
    # Started in the background, pytest and all its children would ignore Ctrl-C.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with throw_away_slurm(tmp_path_factory.mktemp("slurm")) as cluster:
        yield cluster


@pytest.fixture(scope="session")
def overlays(tmp_path_factory) -> list[Path]:
    return [few_jobs(tmp_path_factory.mktemp("overlays") / "few.yaml")]


@pytest.fixture(scope="session")
def local(slurm, overlays, tmp_path_factory) -> Checkout:
    """The workflow, run to its end on this machine, without Slurm."""
    checkout = Checkout.fresh(tmp_path_factory.mktemp("local"))
    checkout.run(overlays=overlays)
    return checkout


@pytest.fixture
def submit(slurm, overlays):
    """Starts Snakemake in a checkout through the profile, its jobs on the cluster."""
    with ExitStack() as stack:
        stack.callback(slurm.cancel_all)

        def start(checkout: Checkout, *arguments: str) -> Submitted:
            run = Submitted(slurm, overlays, checkout, *arguments)
            stack.callback(run.process.wait)
            stack.callback(run.process.kill)
            return run

        yield start


class Submitted:
    """Snakemake at work, and its jobs."""

    def __init__(self, slurm: Slurm, overlays: list[Path], checkout: Checkout, *arguments: str):
        self._slurm, self._output = slurm, checkout.folder / "output.txt"
        self._before = {job.id for job in slurm.queue()}
        with self._output.open("w") as file:
            self.process = subprocess.Popen(
                [*checkout.command(*arguments, overlays=overlays), *PROFILE],
                cwd=checkout.folder,
                env=checkout.environment() | slurm.environment,
                stdout=file,
                stderr=subprocess.STDOUT,
            )

    @property
    def output(self) -> str:
        """All that Snakemake has said."""
        return self._output.read_text()

    def jobs(self) -> list[Job]:
        """Its jobs, also those that have ended."""
        return [job for job in self._slurm.queue() if job.id not in self._before]

    def has_become(self, job: Job, state: str) -> bool:
        """Whether a job is in a state by now."""
        return (job.id, state) in [(other.id, other.state) for other in self.jobs()]

    def working(self, rule: str) -> tuple[Job, int]:
        """Wait for a job of a rule that computes; it, and the process of its script."""
        found: list[tuple[Job, int]] = []

        def works() -> bool:
            assert self.process.poll() is None, self.output
            for job in self.jobs():
                if job.state == "RUNNING" and job.name.startswith(f"rule_{rule}"):
                    if script := self._slurm.script_of(job):
                        found.append((job, script))
            return bool(found)

        wait_for(works, f"job of {rule}", 1800)
        return found[0]

    def wait(self) -> None:
        """Wait for the end of the run, which must be a good one."""
        assert self.process.wait(3600) == 0, self.output


def slow_down(checkout: Checkout, seconds: float) -> None:
    """Have a training rest so long at each point of its curve; its weights stay the same."""
    train = checkout.module("training/train_on_rays.py")
    source = train.read_text()
    call = 'train_to_end(run, advance, header["name"], checkpoint, started'
    assert f"{call})" in source
    slow = source.replace(f"{call})", f"{call}, at_point=lambda step: time.sleep({seconds}))")
    train.write_text(slow)


def test_killed_jobs(slurm, submit, local, overlays, tmp_path):
    checkout = Checkout.fresh(tmp_path / "checkout")
    run = submit(checkout)
    job, _ = run.working("train")
    slurm.ask("scancel", job.id)
    wait_for(lambda: run.has_become(job, "CANCELLED"), "end of the job")
    for rule in ("train", "evaluate"):
        _, script = run.working(rule)
        os.kill(script, signal.SIGKILL)
    run.wait()
    assert differences(results_of(checkout), results_of(local)) == []
    copy = tmp_path / "same measured values"
    assert differing_reports(checkout, local, copy, overlays=overlays) == []
    assert run.output.count("Trying to restart job") == 3
    # Small jobs are submitted together: the meshes', the shards of rays and the reports.
    assert sorted(re.findall(r"Group job ([a-z]+) ", run.output)) == ["prepare", "rays", "reports"]


def test_training_goes_on_after_its_time_limit(submit, local, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    # At least 200 s of training on any machine, in jobs of two minutes; a state is saved each
    # half minute.
    slow_down(checkout, 1)
    run = submit(checkout, WEIGHTS, "--set-resources", "train:runtime=2", "train:gpu=1")
    _, script = run.working("train")
    # Reserved; there is none, so that the network is computed on the CPU all the same.
    assert b"CUDA_VISIBLE_DEVICES=0" in Path(f"/proc/{script}/environ").read_bytes()
    run.wait()
    states = [job.state for job in run.jobs()]
    assert set(states[:-1]) == {"TIMEOUT"} and states[-1] == "COMPLETED"
    log = (checkout.results / "logs" / "train" / "dragon.log").read_text()
    assert int(re.search(r"train dragon: +(\d+) ?%", log)[1]) >= 10
    training = json.loads((checkout.results / "networks/dragon/training.json").read_text())
    assert training["threads"] == 1  # its own, of the node's
    assert (checkout.folder / WEIGHTS).read_bytes() == (local.folder / WEIGHTS).read_bytes()


def test_snakemake_itself_is_interrupted_and_killed(slurm, submit, local, overlays, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    slow_down(checkout, 0.1)
    run = submit(checkout, WEIGHTS)
    job, _ = run.working("train")
    run.process.send_signal(signal.SIGINT)
    assert run.process.wait(120) != 0
    wait_for(lambda: run.has_become(job, "CANCELLED"), "end of the job")
    run = submit(checkout, WEIGHTS)
    job, _ = run.working("train")
    run.process.kill()
    run.process.wait()
    assert run.has_become(job, "RUNNING")
    # As the profile's README says.
    listed = slurm.ask("squeue", "--me", "-h", "--format=%i %j").splitlines()
    assert [line.split()[0] for line in listed if "shadows_" in line] == [job.id]
    slurm.ask("scancel", job.id)
    wait_for(lambda: run.has_become(job, "CANCELLED"), "end of the job")
    checkout.run("--unlock", overlays=overlays)
    submit(checkout, WEIGHTS).wait()
    assert (checkout.folder / WEIGHTS).read_bytes() == (local.folder / WEIGHTS).read_bytes()


def test_too_little_memory_is_tried_with_more(slurm, submit, local, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    memory = ["--set-resources", "draw_directions:mem_mb=150 * attempt"]
    run = submit(checkout, DIRECTIONS, "--forcerun", DIRECTIONS, *memory)
    run.wait()
    states = [job.state for job in run.jobs()]
    assert len(states) > 1 and set(states[:-1]) == {"FAILED"} and states[-1] == "COMPLETED"
    assert "memory limit" in (slurm.folder / "slurmd.log").read_text()
    assert differences(results_of(checkout), results_of(local)) == []
