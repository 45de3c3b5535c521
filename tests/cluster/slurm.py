"""A throw-away Slurm of one node on this machine: own munge, own ports, own folders."""

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

SYSTEM_PATH = ("/usr/sbin", "/sbin")  # where daemons are, often not searched
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

GPUS = """\
Name=gpu File=/dev/null
Name=gpu File=/dev/zero
"""


class Job(NamedTuple):
    """A line of the queue."""

    id: str
    state: str
    name: str
    """What the executor says of it: `rule_train_wildcards_dragon`, `group_rays`."""


def missing_programs() -> list[str]:
    """Programs of Slurm and munge that are not installed."""
    path = os.pathsep.join([os.environ.get("PATH", ""), *SYSTEM_PATH])
    return [name for name in PROGRAMS if shutil.which(name, path=path) is None]


def wait_for(condition: Callable[[], object], what: str, seconds: float = 60) -> None:
    """Wait until `condition()` is true; fails after `seconds`."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"no {what} within {seconds} s"
        time.sleep(0.2)


def _free_port() -> int:
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return listening.getsockname()[1]


@dataclass
class Slurm:
    """One controller and one node, both on this machine.

    Args:
        folder: where all of its files go; its path must be short, since it holds a socket.
    """

    folder: Path
    daemons: dict[str, subprocess.Popen] = field(default_factory=dict)

    @property
    def environment(self) -> dict[str, str]:
        """What the programs of Slurm need to find this cluster, besides `os.environ`."""
        path = [str(self.folder / "bin"), os.environ.get("PATH", ""), *SYSTEM_PATH]
        return {"SLURM_CONF": str(self.folder / "slurm.conf"), "PATH": os.pathsep.join(path)}

    def start(self) -> None:
        """Write the configuration and start munge, the controller and the node."""
        for name in ("bin", "munge", "state", "spool"):
            (self.folder / name).mkdir(mode=0o755)
        # The executor starts srun without any variable of Slurm's, this cluster's name among them.
        srun = self.folder / "bin" / "srun"
        config = self.folder / "slurm.conf"
        srun.write_text(f'#!/bin/sh\nSLURM_CONF={config} exec {shutil.which("srun")} "$@"\n')
        srun.chmod(0o755)
        key = self.folder / "munge" / "key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        (self.folder / "gres.conf").write_text(GPUS)
        (self.folder / "slurm.conf").write_text(
            CONFIG.format(
                folder=self.folder,
                host=socket.gethostname().split(".")[0],
                cpus=os.cpu_count(),
                controller_port=_free_port(),
                node_port=_free_port(),
            )
        )
        munge = self.folder / "munge"
        files = [f"--{name}-file={munge / name}" for name in ("key", "pid", "log", "seed")]
        self._spawn("munged", f"--socket={munge / 'socket'}", *files, "--foreground", "--force")
        wait_for((munge / "socket").exists, "munge socket")
        self.start_daemon("slurmctld")
        wait_for(self.answers, "controller")
        self.start_daemon("slurmd")
        wait_for(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "idle node")

    def start_daemon(self, name: str) -> None:
        """Start `slurmctld` or `slurmd`, for the first time or after it was killed."""
        self._spawn(name, "-D")

    def _spawn(self, name: str, *arguments: str) -> None:
        with (self.folder / f"{name}.out").open("a") as output:
            self.daemons[name] = subprocess.Popen(
                [name, *arguments],
                env=os.environ | self.environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def kill_daemon(self, name: str) -> None:
        """Kill a daemon; what it started runs on."""
        self.daemons[name].kill()
        self.daemons[name].wait()

    def stop(self) -> None:
        """End all jobs and daemons."""
        try:
            running = [job.id for job in self.queue() if job.state == "RUNNING"]
            for step in self.processes_of(*running):
                os.kill(step, signal.SIGKILL)
        finally:  # also where it was the controller that did not start
            for name in ("slurmd", "slurmctld", "munged"):
                if name in self.daemons:
                    self.kill_daemon(name)

    def ask(self, *command: str) -> str:
        """What one of Slurm's programs says; it must succeed."""
        done = subprocess.run(
            command, env=os.environ | self.environment, capture_output=True, text=True, timeout=60
        )
        assert done.returncode == 0, f"{command}: {done.stderr}"
        return done.stdout

    def queue(self) -> list[Job]:
        """Every job that the controller remembers, by its id; it forgets one after five minutes."""
        lines = self.ask("squeue", "-h", "--states=all", "-o", "%i|%T|%k").splitlines()
        return sorted((Job(*line.split("|")) for line in lines), key=lambda job: int(job.id))

    def answers(self) -> bool:
        """Whether the controller does."""
        return (
            subprocess.run(
                ["scontrol", "ping"],
                env=os.environ | self.environment,
                capture_output=True,
                timeout=60,
            ).returncode
            == 0
        )

    def processes_of(self, *jobs: str) -> list[int]:
        """Processes of running jobs, their steps' keepers (slurmstepd) included."""
        ours = f"SLURM_CONF={self.folder / 'slurm.conf'}".encode()
        names = {f"SLURM_JOB_ID={job}".encode() for job in jobs}
        found = []
        for entry in Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                variables = {*(entry / "environ").read_bytes().split(b"\0")}
                title = (entry / "cmdline").read_bytes()
            except OSError:  # ended meanwhile
                continue
            keeper = any(title.startswith(f"slurmstepd: [{job}.".encode()) for job in jobs)
            if ours in variables and (keeper or names & variables):
                found.append(int(entry.name))
        return found
