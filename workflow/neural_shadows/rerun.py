"""The command that runs one job alone, for the message of a job that failed."""

import os
import shlex
from collections.abc import Sequence
from pathlib import Path

_CONFIGURATION = "NEURAL_SHADOWS_CONFIGURATION"


def remember_configuration(configfiles: Sequence[Path], settings: Sequence[str]) -> None:
    """Leave to the jobs how this run was configured, in a variable of the environment.

    Args:
        configfiles: given with `--configfile`; settings: with `--config`.
    """
    paths = [os.path.relpath(path) for path in configfiles]
    given = {"--configfile": paths, "--config": settings}
    arguments = [word for flag, values in given.items() if values for word in (flag, *values)]
    os.environ[_CONFIGURATION] = shlex.join(arguments)


def command_for(target: str, cores: int) -> str:
    """What to type in the folder that Snakemake runs in to make one file, as this run would."""
    # The target comes first: Snakemake takes all that follows --configfile for config files.
    command = f"snakemake --cores {cores} {shlex.quote(target)}"
    return f"{command} {os.environ.get(_CONFIGURATION, '')}".rstrip()
