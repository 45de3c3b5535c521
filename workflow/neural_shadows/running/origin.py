"""What made a result: the checkout's commit, the code that it depends on, the machine."""

import os
import subprocess
from pathlib import Path
from typing import Any

from neural_shadows.running.hardware import describe_machine

CHECKOUT = Path(__file__).resolve().parents[3]

CODE: str | None = None
"""Digest of the modules that the running job's result depends on; None outside of a job."""


def describe_origin() -> dict[str, Any]:
    """`commit`, `code` and `machine`: the same for the same job of the same checkout and machine."""
    return {"commit": commit_of(CHECKOUT), "code": CODE, "machine": describe_machine()}


def commit_of(folder: Path) -> str:
    """The git commit that a folder is checked out at, and whether files differ from it.

    The folder's own: one that lies within another repository is not a checkout of that.
    """
    git = ["git", "-C", str(folder), "describe", "--always", "--exclude=*", "--abbrev=40"]
    own = {"GIT_CEILING_DIRECTORIES": str(folder.resolve().parent)}
    try:
        return subprocess.check_output(
            [*git, "--dirty= with uncommitted changes"],
            env=os.environ | own,
            stderr=subprocess.DEVNULL,
            text=True,
        ).strip()
    except (OSError, subprocess.CalledProcessError):
        return "not a git checkout"
