"""The other renderers' environment, and the numbers that tests measure, printed at the end."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from checkout import ROOT

PYTHON = ROOT / ".venv" / "external" / "bin" / "python"
HOW = (
    f"no {PYTHON.relative_to(ROOT)}. Make it: python -m venv .venv/external && "
    ".venv/external/bin/pip install -r envs/external.txt"
)
Arrays = dict[str, np.ndarray]


@pytest.fixture
def run_outside(tmp_path) -> Callable[..., Arrays]:
    """Run a script of this folder in the other environment: arrays in, arrays out."""
    if not PYTHON.exists():
        pytest.skip(HOW)

    def run(script: str, **arrays) -> Arrays:
        given, taken = tmp_path / "in.npz", tmp_path / "out.npz"
        np.savez(given, **arrays)
        command = [PYTHON, Path(__file__).with_name(script), given, taken]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stdout + done.stderr
        return dict(np.load(taken))

    return run


@pytest.fixture
def measured(record_property) -> Callable[[str], None]:
    """Keep a line for the end of the run."""
    return lambda line: record_property("measured", line)


def pytest_terminal_summary(terminalreporter) -> None:
    reports = [one for many in terminalreporter.stats.values() for one in many]
    lines = {
        line: None
        for report in reports
        for name, line in getattr(report, "user_properties", ())
        if name == "measured"
    }
    if lines:
        terminalreporter.section("measured")
        terminalreporter.write_line("\n".join(lines))
