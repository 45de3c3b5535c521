"""The formatters and linters have nothing to say, and the rooms are in order."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from checkout import ROOT

RULES = ["Snakefile", "workflow/Snakefile", "workflow/rules"]


@pytest.mark.parametrize(
    "tool",
    [
        ["ruff", "check"],
        ["ruff", "format", "--check"],
        ["snakefmt", "--check", *RULES],
        ["snakemake", "--lint"],
        ["lint-imports"],
    ],
    ids=" ".join,
)
def test_clean(tool):
    done = subprocess.run(
        [Path(sys.executable).with_name(tool[0]), *tool[1:]],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": "workflow"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout
