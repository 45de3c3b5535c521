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

    A new file in `workflow` or `config` is one, as a user's own method or overlay. A folder within
    another repository is not a checkout of that. An archive of a commit and a container have it in
    `workflow/COMMIT`.
    """

    def git(*arguments: str) -> str:
        ceiling = {"GIT_CEILING_DIRECTORIES": str(folder.resolve().parent)}
        command, quiet = ["git", "-C", str(folder), *arguments], subprocess.DEVNULL
        env = os.environ | ceiling
        return subprocess.check_output(command, env=env, stderr=quiet, text=True).strip()

    changed = " with uncommitted changes"
    try:
        commit = git("describe", "--always", "--exclude=*", "--abbrev=40", f"--dirty={changed}")
        new = git("ls-files", "--others", "--exclude-standard", "--", "workflow", "config")
        return commit + changed * bool(new and not commit.endswith(changed))
    except (OSError, subprocess.CalledProcessError):
        archived = folder / "workflow/COMMIT"
        commit = archived.read_text(encoding="utf-8").strip() if archived.is_file() else ""
        return commit if commit.isalnum() else "not a git checkout"
