"""The workflow on a real Slurm: killed jobs and daemons, time limits and too little memory."""

import importlib.util
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from checkout import SMOKE, Checkout
from same_results import differences, reports_of, results_of, take_measured
from slurm import Job, Slurm, missing_programs, wait_for

WEIGHTS = "results/smoke/networks/dragon/weights.safetensors"

# The profile as it is, but for what this small cluster needs: it has no accounting, and its
# jobs last seconds.
PROFILE = [
    *("--workflow-profile", "workflow/profiles/slurm"),
    *("--slurm-status-command", "squeue"),
    *("--slurm-init-seconds-before-status-checks", "2"),
]


@pytest.fixture(scope="session", autouse=True)
def interruptible():
    """Started in the background, pytest and all its children would ignore Ctrl-C."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="session")
def slurm(tmp_path_factory) -> Iterator[Slurm]:
    if missing := missing_programs():
        pytest.skip(f"not installed: {', '.join(missing)} (apt-get install slurm-wlm munge)")
    if importlib.util.find_spec("snakemake_executor_plugin_slurm") is None:
        pytest.skip("Snakemake's executor is not installed (pip install -r envs/slurm.txt)")
    if os.geteuid() != 0:
        pytest.skip("the daemons of this cluster, and so its jobs, run as root")
    cluster = Slurm(tmp_path_factory.mktemp("slurm"))
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()


@pytest.fixture(scope="session")
def fresh(slurm, tmp_path_factory) -> Checkout:
    """A checkout in which nothing has run."""
    return Checkout.fresh(tmp_path_factory.mktemp("fresh"))


@pytest.fixture(scope="session")
def local(fresh, tmp_path_factory) -> Checkout:
    """The smoke workflow, run to its end on this machine, without Slurm."""
    checkout = fresh.copy(tmp_path_factory.mktemp("local"))
    checkout.run()
    return checkout


class Submitted:
    """Snakemake at work in a checkout, with its jobs on the cluster."""

    def __init__(self, slurm: Slurm, process: subprocess.Popen, output: Path):
        self.slurm, self.process, self._output = slurm, process, output
        self.before = {job.id for job in slurm.queue()}

    @property
    def output(self) -> str:
        """All that Snakemake has said."""
        return self._output.read_text()

    def jobs(self) -> list[Job]:
        """Its jobs, also those that have ended."""
        return [job for job in self.slurm.queue() if job.id not in self.before]

    def working(self, name: str) -> tuple[Job, list[int]]:
        """Wait for a job of this name that computes; it, and the processes of its scripts."""
        deadline = time.monotonic() + 1800
        while self.process.poll() is None and time.monotonic() < deadline:
            for job in self.jobs():
                if job.state == "RUNNING" and job.name.startswith(f"rule_{name}"):
                    processes = self.slurm.processes_of(job.id)
                    if scripts := [pid for pid in processes if _is_script(pid)]:
                        return job, scripts
            time.sleep(0.1)
        raise AssertionError(f"no job of {name} works:\n{self.output}")

    def wait(self) -> None:
        """Wait for the end of the run, which must be a good one."""
        assert self.process.wait(3600) == 0, self.output


def _is_script(pid: int) -> bool:
    try:
        return b"/.snakemake/scripts/" in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


@contextmanager
def submitted(slurm: Slurm, checkout: Checkout, *arguments: str) -> Iterator[Submitted]:
    """Run Snakemake through the profile at the smoke scale."""
    output = checkout.folder / "output.txt"
    with output.open("w") as file:
        process = subprocess.Popen(
            [sys.executable, "-m", "snakemake", *arguments, *PROFILE, "--configfile", str(SMOKE)],
            cwd=checkout.folder,
            env=checkout.environment() | slurm.environment,
            stdout=file,
            stderr=subprocess.STDOUT,
        )
    try:
        yield Submitted(slurm, process, output)
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
            slurm.ask("scancel", "--me")


def slow_down(checkout: Checkout, seconds: float) -> None:
    """Have a training rest so long after each of its 200 steps; its weights stay the same."""
    with checkout.module("training.py").open("a") as file:
        file.write(
            "\n\ndef check_alive(*args, _check=check_alive):\n"
            f"    time.sleep({seconds})\n"
            "    _check(*args)\n"
        )


def kill_script(slurm: Slurm, job: Job, scripts: list[int]) -> None:
    os.kill(scripts[0], signal.SIGKILL)


def cancel(slurm: Slurm, job: Job, scripts: list[int]) -> None:
    slurm.ask("scancel", job.id)


def kill_controller(slurm: Slurm, job: Job, scripts: list[int]) -> None:
    slurm.kill_daemon("slurmctld")
    time.sleep(5)
    slurm.start_daemon("slurmctld")
    wait_for(slurm.answers, "controller")


def kill_node_daemon(slurm: Slurm, job: Job, scripts: list[int]) -> None:
    slurm.kill_daemon("slurmd")
    time.sleep(5)
    slurm.start_daemon("slurmd")


def crash_node(slurm: Slurm, job: Job, scripts: list[int]) -> None:
    """The daemon and all that it started go at once, and the controller is told."""
    slurm.kill_daemon("slurmd")
    running = [job.id for job in slurm.queue() if job.state == "RUNNING"]
    for pid in slurm.processes_of(*running):
        os.kill(pid, signal.SIGKILL)
    node = slurm.ask("sinfo", "-h", "-o", "%N").strip()
    slurm.ask("scontrol", "update", f"nodename={node}", "state=down", "reason=crashed")
    slurm.start_daemon("slurmd")
    slurm.ask("scontrol", "update", f"nodename={node}", "state=resume")


# What is done in turn, each as soon as a job of that name works.
DISTURBANCES: list[tuple[str, Callable[[Slurm, Job, list[int]], None]]] = [
    ("rays", kill_script),
    ("train", cancel),
    ("train", kill_controller),
    ("train", kill_node_daemon),
    ("train", kill_script),
    ("evaluate", crash_node),
]


def test_killed_jobs_and_daemons(slurm, fresh, local, tmp_path):
    checkout = fresh.copy(tmp_path / "checkout")
    started = time.monotonic()
    with submitted(slurm, checkout) as run:
        for name, disturb in DISTURBANCES:
            job, scripts = run.working(name)
            print(f"{time.monotonic() - started:.0f} s: {disturb.__name__} at {job.name}")
            disturb(slurm, job, scripts)
        run.wait()
        count = run.output.count("has been submitted with SLURM jobid")
    print(f"{time.monotonic() - started:.0f} s, {count} jobs of Slurm's")
    assert differences(results_of(checkout), results_of(local)) == []
    # Reports show measured values: those of the cluster's run, put into the local one.
    copy = local.copy(tmp_path / "same measured values")
    take_measured(checkout, copy)
    copy.run()
    assert differences(reports_of(checkout), reports_of(copy)) == []
    assert run.output.count("Trying to restart job") >= 3
    groups = set(re.findall(r"/group_([a-z]+)_", run.output))
    assert groups == {"prepare", "rays", "reports"}
    # Each job has a log of its own. Small ones are submitted together.
    assert count < len({row["log-file(s)"] for row in local.summary()}) * 2 / 3


def test_training_goes_on_after_its_time_limit(slurm, local, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    # At least 200 s of training on any machine, in jobs of two minutes; a state is saved each
    # half minute.
    slow_down(checkout, 1)
    limits = ["--set-resources", "train:runtime=2", "train:gpu=1"]
    with submitted(slurm, checkout, WEIGHTS, *limits) as run:
        _, (script, *_) = run.working("train")
        # Reserved; there is none, so that the network is computed on the CPU all the same.
        assert b"CUDA_VISIBLE_DEVICES=0" in Path(f"/proc/{script}/environ").read_bytes()
        run.wait()
        states = [job.state for job in run.jobs()]
    log = (checkout.results / "logs" / "train" / "dragon.log").read_text()
    share = int(re.search(r"train dragon: +(\d+)%", log)[1])
    print(f"{states}, the last from {share} % on")
    assert set(states[:-1]) == {"TIMEOUT"} and states[-1] == "COMPLETED"
    assert share >= 10
    weights = (checkout.folder / WEIGHTS).read_bytes()
    assert weights == (local.folder / WEIGHTS).read_bytes()


def test_snakemake_itself_is_interrupted_and_killed(slurm, local, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    slow_down(checkout, 0.1)

    def state_of(job: Job) -> str:
        return next(other.state for other in slurm.queue() if other.id == job.id)

    with submitted(slurm, checkout, WEIGHTS) as run:
        job, _ = run.working("train")
        run.process.send_signal(signal.SIGINT)
        assert run.process.wait(120) != 0
        wait_for(lambda: state_of(job) == "CANCELLED", "end of the job")
    with submitted(slurm, checkout, WEIGHTS) as run:
        job, _ = run.working("train")
        run.process.kill()
        run.process.wait()
        assert state_of(job) == "RUNNING"
        # As the profile's README says.
        listed = slurm.ask("squeue", "--me", "-h", "--format=%i %j").splitlines()
        assert [line.split()[0] for line in listed if "shadows_" in line] == [job.id]
        slurm.ask("scancel", job.id)
        wait_for(lambda: state_of(job) == "CANCELLED", "end of the job")
    checkout.run("--unlock")
    with submitted(slurm, checkout, WEIGHTS) as run:
        run.wait()
    weights = (checkout.folder / WEIGHTS).read_bytes()
    assert weights == (local.folder / WEIGHTS).read_bytes()


def test_too_little_memory_is_tried_with_more(slurm, local, tmp_path):
    checkout = local.copy(tmp_path / "checkout")
    rules = checkout.folder / "workflow" / "rules" / "rays.smk"
    text = rules.read_text()
    changed = text.replace("mem_mb=per_attempt(1000)", "mem_mb=per_attempt(150)", 1)
    assert changed != text
    rules.write_text(changed)
    target = "results/smoke/rays/dragon/uniform/directions.npy"
    with submitted(slurm, checkout, target, "--forcerun", target) as run:
        run.wait()
        jobs = run.jobs()
    states = [job.state for job in jobs]
    print(states)
    assert len(states) > 1 and set(states[:-1]) == {"FAILED"} and states[-1] == "COMPLETED"
    assert "memory limit" in (slurm.folder / "slurmd.log").read_text()
    assert differences(results_of(checkout), results_of(local)) == []
