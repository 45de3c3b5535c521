"""After the clock was set back, a run says so, and what it says to do leads to right results.

The clock of the machine is left alone. What a later run sees of a clock that was set back is
files from the future, and those are made by dating a half-finished run's forward. (libfaketime
would fake the times that processes see, but not those that the kernel gives to files.)
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from signal import SIGKILL

import pytest
from victim import Victim

DAY_S = 86_400


@pytest.mark.usefixtures("only_full")
def test_clock_set_back(undisturbed):
    checkout = undisturbed.another(finished=True)
    for folder in (checkout.results / "evaluations", checkout.reports):
        shutil.rmtree(folder)
    victim = Victim(undisturbed, checkout)
    assert victim.interrupt(SIGKILL, victim.in_job("evaluate", 0.5))
    for path in checkout.folder.rglob("*"):
        if path.is_file():
            stat = path.stat()
            os.utime(path, (stat.st_atime + DAY_S, stat.st_mtime + DAY_S))

    arguments = *undisturbed.targets, "--rerun-incomplete"
    failed = checkout.snakemake(*arguments, overlays=undisturbed.overlays)
    assert failed.returncode != 0
    assert "s in the future. If the clock is wrong, set it right." in failed.stdout
    assert "Execute" not in failed.stdout and "Traceback" not in failed.stdout

    (command,) = re.findall("python (-m neural_shadows.file_times .*)", failed.stdout)
    command = [sys.executable, *shlex.split(command)]
    environment = checkout.environment() | {"PYTHONPATH": str(checkout.folder / "workflow")}
    subprocess.run(command, check=True, cwd=checkout.folder, env=environment)
    # What was made before is not made again.
    said = checkout.run(*arguments, "--dry-run", overlays=undisturbed.overlays)
    assert re.search("^evaluate +[1-9]", said, re.MULTILINE)
    assert not re.search("^(train|label_rays|prepare_mesh) ", said, re.MULTILINE)
    undisturbed.finish(checkout)
    undisturbed.same_as(checkout)
