"""A throw-away Slurm of one node on this machine: own munge, own ports, own folders."""

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

# Daemons are where is often not searched.
PATH = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scancel", "scontrol")

CONFIG = """\
ClusterName=throwaway
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
# A container has no cgroups to give away.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
MpiDefault=none
AccountingStorageType=accounting_storage/none
# Memory is looked at every second, and a job with more than it asked for is killed.
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
JobAcctGatherParams=OverMemoryKill
# From SIGTERM at a job's time limit to SIGKILL.
KillWait=5
SlurmdTimeout=60
ReturnToService=2
# The node may promise memory and GPUs that this machine lacks: a small one is enough for smoke.
SlurmdParameters=config_overrides
GresTypes=gpu
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory=64000 Gres=gpu:2 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class Job(NamedTuple):
    """A line of the queue."""

    id: str
    state: str
    name: str
    """What the executor says of it: `rule_train_wildcards_dragon`, `group_rays`."""


def missing() -> list[str]:
    """What this machine lacks for a throw-away cluster."""
    lacking = [name for name in PROGRAMS if shutil.which(name, path=PATH) is None]
    if find_spec("snakemake_executor_plugin_slurm") is None:
        lacking.append("snakemake-executor-plugin-slurm")
    return lacking if os.geteuid() == 0 else [*lacking, "root, which its daemons and jobs run as"]


def wait_for(condition: Callable[[], object], what: str) -> None:
    """Wait until `condition()` is true; fails after a minute."""
    deadline = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < deadline, f"no {what} within a minute"
        time.sleep(0.2)


def _free_port() -> int:
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return listening.getsockname()[1]


class Slurm:
    """One controller and one node, both on this machine.

    Args:
        folder: where all of its files go; its path must be short, since it holds a socket.
    """

    def __init__(self, folder: Path):
        self.folder, self.config = folder, folder / "slurm.conf"
        self._daemons: list[subprocess.Popen] = []
        # What the programs of Slurm need to find this cluster, besides `os.environ`.
        path = os.pathsep.join([str(folder / "bin"), PATH])
        self.environment = {"SLURM_CONF": str(self.config), "PATH": path}

    def start(self) -> None:
        """Write the configuration and start munge, the controller and the node."""
        for name in ("bin", "munge", "state", "spool"):
            (self.folder / name).mkdir(mode=0o755)
        # The executor starts srun without any variable of Slurm's, this cluster's name among them.
        srun = self.folder / "bin" / "srun"
        program = shutil.which("srun", path=PATH)
        srun.write_text(f'#!/bin/sh\nSLURM_CONF={self.config} exec {program} "$@"\n')
        srun.chmod(0o755)
        munge = self.folder / "munge"
        (munge / "key").write_bytes(os.urandom(128))
        (munge / "key").chmod(0o400)
        gpus = "Name=gpu File=/dev/null\nName=gpu File=/dev/zero\n"
        (self.folder / "gres.conf").write_text(gpus)
        self.config.write_text(
            CONFIG.format(
                folder=self.folder,
                host=socket.gethostname().split(".")[0],
                cpus=os.cpu_count(),
                controller_port=_free_port(),
                node_port=_free_port(),
            )
        )
        files = [f"--{name}-file={munge / name}" for name in ("key", "pid", "log", "seed")]
        self._start("munged", f"--socket={munge}/socket", *files, "--foreground", "--force")
        wait_for((munge / "socket").exists, "munge socket")
        self._start("slurmctld", "-D")
        wait_for(lambda: self._run("scontrol", "ping").returncode == 0, "controller")
        self._start("slurmd", "-D")
        wait_for(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "idle node")

    def _start(self, *command: str) -> None:
        with (self.folder / f"{command[0]}.out").open("w") as output:
            daemon = subprocess.Popen(
                command,
                env=os.environ | self.environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        self._daemons.append(daemon)

    def stop(self) -> None:
        """End all jobs and daemons."""
        try:
            for pid in self.processes_of(*(job.id for job in self.queue())):
                os.kill(pid, signal.SIGKILL)
        finally:  # also where it was the controller that did not start
            for daemon in reversed(self._daemons):
                daemon.kill()
                daemon.wait()

    def _run(self, *command: str) -> subprocess.CompletedProcess[str]:
        environment = os.environ | self.environment
        return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)

    def ask(self, *command: str) -> str:
        """What one of Slurm's programs says; it must succeed."""
        done = self._run(*command)
        assert done.returncode == 0, f"{command}: {done.stderr}"
        return done.stdout

    def queue(self) -> list[Job]:
        """Every job that the controller remembers, by its id; it forgets one after five minutes."""
        lines = self.ask("squeue", "-h", "--states=all", "-o", "%i|%T|%k").splitlines()
        return sorted((Job(*line.split("|")) for line in lines), key=lambda job: int(job.id))

    def processes_of(self, *jobs: str) -> list[int]:
        """Processes of running jobs, their steps' keepers (slurmstepd) included."""
        ours = f"SLURM_CONF={self.config}".encode()
        names = {f"SLURM_JOB_ID={job}".encode() for job in jobs}
        found = []
        for entry in Path("/proc").glob("[0-9]*"):
            try:
                variables = {*(entry / "environ").read_bytes().split(b"\0")}
                title = (entry / "cmdline").read_bytes()
            except OSError:  # ended meanwhile
                continue
            keeper = any(title.startswith(f"slurmstepd: [{job}.".encode()) for job in jobs)
            if ours in variables and (keeper or names & variables):
                found.append(int(entry.name))
        return found
