"""Provenance of a table or figure: script, section of the configuration, inputs, origin."""

import ast
import hashlib
import re
import sys
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import sha256_of
from neural_shadows.running.origin import CHECKOUT, describe_origin

JOB: Any = None
"""Snakemake's object of the running job; None outside of one."""


def describe_provenance() -> dict[str, Any]:
    """`script`, `section`, `seed` and `inputs` (SHA-256 by path) of the running job, and its origin.

    The origin alone outside of a job. No time: the same job gives the same bytes.
    """
    if JOB is None:
        return describe_origin()
    wildcards, settings = dict(JOB.wildcards.items()), dict(JOB.params.items()).get("settings", {})
    return {
        "script": _script(),
        "section": ", ".join(f"{name}s.{value}" for name, value in wildcards.items()) or JOB.rule,
        "seed": settings.get("run", {}).get("seed"),
        **describe_origin(),
        "inputs": {path: sha256_of(path) for path in _inputs()},
    }


def log_line(origin: dict[str, Any]) -> str:
    """The first line of a job's log."""
    return "Made by commit {commit}, code {code}, {machine}".format(**origin)


def read_log_line(line: str) -> dict[str, Any] | None:
    """Commit and machine of `log_line`; None of another line."""
    match = re.fullmatch(r"Made by commit (.+), code \w+, (\{.+\})", line)
    return match and {"commit": match[1], "machine": ast.literal_eval(match[2])}


def describe_hardware(machine: dict[str, Any]) -> str:
    """Name a machine's processor, cores and GPU."""
    cores = f"{machine['cores']} core{'s' * (machine['cores'] != 1)}"
    return ", ".join(filter(None, (machine["cpu"], cores, machine["gpu"])))


def _script() -> str:
    """Path of the running script in the checkout; of a table or figure, of its kind's module."""
    # Snakemake runs a copy, and sets `__file__` to the original.
    module = dict(JOB.params.items()).get("module", "__main__")
    path = Path(sys.modules[module].__file__)
    return str(path.relative_to(CHECKOUT)) if path.is_relative_to(CHECKOUT) else path.name


def _inputs() -> list[str]:
    """Files that the job reads; those of `beside` are built along with it."""
    named = (
        (name, [files] if isinstance(files, str) else files) for name, files in JOB.input.items()
    )
    return sorted({path for name, files in named if name != "beside" for path in files})


def provenance_line(record: dict[str, Any]) -> str:
    """Describe a provenance in a line of Markdown; inputs by their number and a digest."""
    machine, inputs = record["machine"], record.get("inputs", {})
    listed = "".join(f"{digest}  {path}\n" for path, digest in inputs.items())
    parts = [
        f"`{record['script']}`" if "script" in record else "",
        f"section `{record['section']}`" if "section" in record else "",
        f"{len(inputs)} input{'s' * (len(inputs) != 1)}, SHA-256 of their list "
        f"`{hashlib.sha256(listed.encode()).hexdigest()[:16]}`"
        if inputs
        else "",
        f"seed {record['seed']}" if record.get("seed") is not None else "",
        f"commit {record['commit']}",
        f"code `{record['code']}`" if record["code"] else "",
        describe_hardware(machine),
        f"Python {machine['python']}, torch {machine['torch']}",
    ]
    return f"Made by {'; '.join(filter(None, parts))}."
