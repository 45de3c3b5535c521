"""A throw-away Slurm of one node on this machine: own munge, own ports, own folders."""

import os
import shutil
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
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
# Memory is looked at every second, and a job with more than it asked for is killed.
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
JobAcctGatherParams=OverMemoryKill
# From SIGTERM at a job's time limit to SIGKILL.
KillWait=5
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


class Slurm:
    """What Slurm's programs say of the cluster whose files are in a folder."""

    def __init__(self, folder: Path):
        self.folder, self.config = folder, folder / "slurm.conf"
        # What they need to find it, besides `os.environ`.
        path = os.pathsep.join([str(folder / "bin"), PATH])
        self.environment = {"SLURM_CONF": str(self.config), "PATH": path}

    def ask(self, *command: str) -> str:
        """What one of the programs says; it must succeed."""
        environment = os.environ | self.environment
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, f"{command}: {done.stderr}"
        return done.stdout

    def queue(self) -> list[Job]:
        """Every job that the controller remembers, by its id; it forgets one after five minutes."""
        lines = self.ask("squeue", "-h", "--states=all", "-o", "%i|%T|%k").splitlines()
        return sorted((Job(*line.split("|")) for line in lines), key=lambda job: int(job.id))

    def cancel_all(self) -> None:
        """End all jobs."""
        self.ask("scancel", "--me")
        wait_for(lambda: not self.ask("squeue", "-h"), "end of all jobs")

    def script_of(self, job: Job) -> int | None:
        """The process of a running job that runs a rule's script."""
        variable = f"SLURM_JOB_ID={job.id}".encode()
        for entry in Path("/proc").glob("[0-9]*"):
            try:
                variables = (entry / "environ").read_bytes().split(b"\0")
                arguments = [*(entry / "cmdline").read_bytes().split(b"\0"), b""]
            except OSError:  # ended meanwhile
                continue
            # Of bash, which starts it, the script is not an argument of its own.
            if variable in variables and b"/.snakemake/scripts/" in arguments[1]:
                return int(entry.name)
        return None


def missing() -> list[str]:
    """What this machine lacks for a throw-away cluster."""
    lacking = [name for name in PROGRAMS if shutil.which(name, path=PATH) is None]
    if find_spec("snakemake_executor_plugin_slurm") is None:
        lacking.append("snakemake-executor-plugin-slurm")
    return lacking if os.geteuid() == 0 else [*lacking, "root, which its daemons and jobs run as"]


@contextmanager
def throw_away_slurm(folder: Path) -> Iterator[Slurm]:
    """One controller and one node, both on this machine.

    Args:
        folder: where all of its files go; its path must be short, since it holds a socket.
    """
    slurm, munge = Slurm(folder), folder / "munge"
    _write_files(slurm)
    with ExitStack() as daemons:

        def start(*command: str) -> None:
            output = daemons.enter_context((folder / f"{command[0]}.out").open("w"))
            daemon = subprocess.Popen(
                command,
                env=os.environ | slurm.environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            daemons.callback(daemon.wait)
            daemons.callback(daemon.kill)

        files = [f"--{name}-file={munge / name}" for name in ("key", "pid", "log", "seed")]
        start("munged", f"--socket={munge}/socket", *files, "--foreground", "--force")
        wait_for((munge / "socket").exists, "munge socket")
        start("slurmctld", "-D")
        start("slurmd", "-D")
        # Until the controller is up, `sinfo` itself waits for it.
        wait_for(lambda: "idle" in slurm.ask("sinfo", "-h", "-o", "%T"), "idle node")
        yield slurm
        slurm.cancel_all()


def _write_files(slurm: Slurm) -> None:
    for name in ("bin", "munge", "state", "spool"):
        (slurm.folder / name).mkdir(mode=0o755)
    # The executor starts srun without any variable of Slurm's, this cluster's name among them.
    srun = slurm.folder / "bin" / "srun"
    program = shutil.which("srun", path=PATH)
    srun.write_text(f'#!/bin/sh\nSLURM_CONF={slurm.config} exec {program} "$@"\n')
    srun.chmod(0o755)
    key = slurm.folder / "munge" / "key"
    key.write_bytes(os.urandom(128))
    key.chmod(0o400)
    gpus = "Name=gpu File=/dev/null\nName=gpu File=/dev/zero\n"
    (slurm.folder / "gres.conf").write_text(gpus)
    settings = {"host": socket.gethostname().split(".")[0], "cpus": os.cpu_count()}
    ports = {"controller_port": _free_port(), "node_port": _free_port()}
    slurm.config.write_text(CONFIG.format(folder=slurm.folder, **settings, **ports))


def _free_port() -> int:
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return listening.getsockname()[1]


def wait_for(condition: Callable[[], object], what: str, seconds: float = 60) -> None:
    """Wait until `condition()` is true; fails after so many seconds."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"no {what} within {seconds} s"
        time.sleep(0.1)
