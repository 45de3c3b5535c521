"""What the benchmarks print is right; how fast anything is they measure and no test asserts."""

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import run
import start_share
from measurement import COLUMNS, Row, median_seconds, table


def test_run_imports_every_benchmark():
    assert {path.stem for path in Path(run.__file__).parent.glob("bench_*.py")} <= vars(run).keys()


def test_the_readme_s_command_finds_its_modules():
    """Without pytest's own paths."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [sys.executable, run.__file__, "--help"]
    usage = subprocess.check_output(command, text=True, env=environment)
    assert "--quick" in usage


def test_each_rule_has_a_script_whose_start_is_measured():
    rules = (start_share.ROOT / "workflow/rules").glob("*.smk")
    named = re.findall(r"^rule (\w+):", "".join(path.read_text() for path in rules), re.M)
    scripts = start_share.modules()
    assert len(named) > 20 and {*scripts} == {*named}
    assert all(importlib.util.find_spec(module) for module in scripts.values())


def test_shares_and_ratios():
    rows = table(
        [
            Row("labels", "cpu", 3.0, "samples/s", ceiling=4.0, peer="trimesh", peer_rate=0.5),
            Row("rays", "cpu", 2.0, "samples/s"),
        ]
    )
    assert list(rows) == COLUMNS
    assert rows.iloc[0][["share", "ratio"]].tolist() == [0.75, 6.0]
    assert rows.iloc[1][["ceiling", "share", "peer", "ratio"]].isna().all()


def test_works_are_done_in_turn_and_the_first_round_does_not_count(monkeypatch):
    clock, done = [0.0], []
    monkeypatch.setattr("measurement.time.perf_counter", lambda: clock[0])
    seconds = {"a": iter([9, 1, 2, 6]), "b": iter([9, 4, 3, 5])}

    def work(name):
        done.append(name)
        clock[0] += next(seconds[name])

    medians = median_seconds({"a": lambda: work("a"), "b": lambda: work("b")}, 3)
    assert done == ["a", "b"] * 4
    assert medians == {"a": pytest.approx(2), "b": pytest.approx(4)}
