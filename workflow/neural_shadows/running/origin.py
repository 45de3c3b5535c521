"""Origin of a result: commit, code and machine."""

import os
import subprocess
from pathlib import Path
from typing import Any

from neural_shadows.running.hardware import describe_machine

CHECKOUT = Path(__file__).resolve().parents[3]

CODE: str | None = None
"""Digest of the modules behind the running job's result; None outside of a job."""


def describe_origin() -> dict[str, Any]:
    """`commit`, `code` and `machine` of the running job."""
    return {"commit": commit_of(CHECKOUT), "code": CODE, "machine": describe_machine()}


def commit_of(folder: Path) -> str:
    """Git commit of a folder, with a note on uncommitted changes.

    A folder within another repository is not a checkout of that. An archive of a commit and a
    container have it in `workflow/COMMIT`.
    """
    git = ["git", "-C", str(folder), "describe", "--always", "--exclude=*", "--abbrev=40"]
    ceiling = {"GIT_CEILING_DIRECTORIES": str(folder.resolve().parent)}
    try:
        return subprocess.check_output(
            [*git, "--dirty= with uncommitted changes"],
            env=os.environ | ceiling,
            stderr=subprocess.DEVNULL,
            text=True,
        ).strip()
    except (OSError, subprocess.CalledProcessError):
        archived = folder / "workflow/COMMIT"
        commit = archived.read_text(encoding="utf-8").strip() if archived.is_file() else ""
        return commit if commit.isalnum() else "not a git checkout"
