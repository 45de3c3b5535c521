import json
import os
import signal
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from sample_records import MACHINE

from neural_shadows.evaluation.costs import STAGES
from neural_shadows.evaluation.measure_cost import (
    BASE,
    NEEDED,
    TINY,
    _in_process,
    bumpy_sphere,
    size_of,
)
from neural_shadows.reports.figures.cost import cost_figure
from neural_shadows.reports.tables.cost import cost_table, growth, write_cost_table


def measured(size: int) -> dict:
    """Labels linear in the samples, training as the root; one MiB whatever the samples."""
    return {
        "over": "samples",
        "size": size,
        "stages": [
            {"stage": "labels", "seconds": 1e-6 * size, "bytes": 2**20, "peak_bytes": 2**21},
            {"stage": "training", "seconds": size**0.5, "bytes": 0, "peak_bytes": 2**21},
        ],
        "machine": MACHINE,
        "threads": 2,
    }


@pytest.mark.parametrize("exponent", [0, 0.5, 1, 2])
def test_growth_is_the_exponent_of_a_power(exponent):
    sizes = np.array([1000, 10, 100, 10000])
    assert growth(sizes, 3.0 * sizes**exponent) == pytest.approx(exponent, abs=1e-9)


def test_growth_is_that_of_the_largest_sizes():
    sizes = np.array([1, 10, 100, 1000])
    assert growth(sizes, np.array([50.0, 10, 100, 1000])) == pytest.approx(1)
    assert np.isnan(growth(sizes[:1], np.array([1.0])))
    assert np.isnan(growth(sizes, np.zeros(4)))


def test_table_has_a_row_for_each_stage_and_size(tmp_path):
    paths = []
    for size in (10**4, 10**2, 10**3):
        paths.append(tmp_path / f"{size}.json")
        paths[-1].write_text(json.dumps(measured(size)))
    csv, md = tmp_path / "cost.csv", tmp_path / "cost.md"
    write_cost_table(paths, csv, md, title="Costs", scale="test")
    table = pd.read_csv(csv)
    assert table["stage"].tolist() == ["labels"] * 3 + ["training"] * 3
    assert table["size"].tolist() == [100, 1000, 10000] * 2
    labels, training = (table[table["stage"] == stage] for stage in ("labels", "training"))
    assert labels["seconds_exponent"].tolist() == pytest.approx([1] * 3)
    assert training["seconds_exponent"].tolist() == pytest.approx([0.5] * 3)
    assert labels["memory_mib"].tolist() == [1] * 3
    assert labels["memory_mib_exponent"].tolist() == pytest.approx([0] * 3, abs=1e-9)
    assert training["memory_mib_exponent"].isna().all()
    assert "a CPU, 2 threads" in md.read_text()


def test_figure_has_a_line_for_each_stage_of_a_size():
    figure = cost_figure(cost_table([measured(size) for size in (10, 100)]), title="Costs")
    seconds, memory = figure.axes
    assert [line.get_label() for line in seconds.lines] == ["labels (1.00)", "training (0.50)"]
    assert [line.get_label() for line in memory.lines] == ["labels (0.00)"]
    assert seconds.get_xlabel() == "samples"


def test_sizes_are_shown_as_what_they_make():
    assert size_of("subdivisions", 3) == ("triangles", len(bumpy_sphere(3).faces))
    assert size_of("frame_width", 600) == ("pixels", 600 * 400)
    assert size_of("samples", 1000) == ("samples", 1000)
    assert bumpy_sphere(3).is_watertight


def test_every_size_has_stages_whose_files_can_be_made():
    assert set(STAGES) == set(BASE) == set(TINY)
    for stages in STAGES.values():
        for stage in stages:
            assert NEEDED[stage][-1] == stage


KILLED = """
import os, signal, sys
from pathlib import Path
from neural_shadows.evaluation import measure_cost as cost

def killed(stage, folder, sizes, settings):
    (folder / "origins.000.npy").write_bytes(b"gigabytes")
    os.kill(os.getpid(), signal.SIGKILL)

def measured(stage, folder, sizes, settings):
    return {"seconds": 1.0, "files": sorted(path.name for path in folder.iterdir())}

cost._in_process = {"killed": killed, "measured": measured}[sys.argv[1]]
out = Path(sys.argv[2])
cost.measure_cost(out, over="samples", value=4, seed=0, device="cpu", precision="auto", threads=1)
"""


def test_what_a_killed_measurement_left_is_removed(tmp_path):
    def measure(how: str) -> int:
        command = [sys.executable, "-c", KILLED, how, tmp_path / "samples.4.json"]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        return subprocess.run(command, env=environment, timeout=60).returncode

    assert measure("killed") == -signal.SIGKILL
    assert len(list(tmp_path.rglob("origins.*"))) == 1
    assert measure("measured") == 0
    assert [path.name for path in tmp_path.iterdir()] == ["samples.4.json"]
    stages = json.loads((tmp_path / "samples.4.json").read_text())["stages"]
    assert stages and all(stage["files"] == [] for stage in stages)


def test_a_stage_that_fails_says_why(tmp_path, monkeypatch):
    """On a disk that is full its log would not."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    with pytest.raises(RuntimeError, match=r"none at .*: KeyError: 'none'"):
        _in_process("none", tmp_path, TINY, {})
