import json
import os

import pytest
import torch

from neural_shadows.running import hardware
from neural_shadows.running.hardware import describe_machine


@pytest.mark.parametrize(
    ("cpuinfo", "name"),
    [
        ("processor\t: 0\nmodel name\t: AMD EPYC: 9654\ncpu MHz\t: 1\n", "AMD EPYC: 9654"),
        ("processor\t: 0\nCPU implementer\t: 0x41\n", "arm"),  # ARM gives no name
        (None, "arm"),  # not Linux
    ],
)
def test_description(tmp_path, monkeypatch, cpuinfo, name):
    monkeypatch.setattr(hardware, "CPUINFO", tmp_path / "cpuinfo")
    monkeypatch.setattr(hardware.platform, "processor", lambda: "arm")
    if cpuinfo:
        (tmp_path / "cpuinfo").write_text(cpuinfo)
    machine = describe_machine()
    # No host name, no user, no path: results are published.
    assert list(machine) == ["cpu", "cores", "gpu", "system", "python", "torch"]
    assert machine == json.loads(json.dumps(machine))
    assert machine["cpu"] == name and machine["torch"] == torch.__version__
    assert 1 <= machine["cores"] <= os.cpu_count()
    assert (machine["gpu"] is None) == (not torch.cuda.is_available())
