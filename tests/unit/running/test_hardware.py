"""A machine's description says what it computes with, and nothing of whose it is."""

import json
import os
from pathlib import Path

import pytest
import torch

from neural_shadows.running import hardware
from neural_shadows.running.hardware import describe_machine, processor_name


def test_description():
    machine = describe_machine()
    # No host name, no user, no path: results are published.
    assert list(machine) == ["cpu", "cores", "gpu", "system", "python", "torch"]
    assert machine == json.loads(json.dumps(machine))
    assert 1 <= machine["cores"] <= os.cpu_count()
    assert machine["cpu"] and machine["torch"] == torch.__version__
    assert (machine["gpu"] is None) == (not torch.cuda.is_available())


@pytest.mark.parametrize(
    ("cpuinfo", "name"),
    [
        ("processor\t: 0\nmodel name\t: AMD EPYC: 9654\ncpu MHz\t: 1\n", "AMD EPYC: 9654"),
        ("processor\t: 0\nCPU implementer\t: 0x41\n", "machine"),  # ARM gives no name
        (None, "machine"),  # not Linux
    ],
)
def test_processor_name(monkeypatch, cpuinfo, name):
    def read_text(self):
        assert str(self) == "/proc/cpuinfo"
        if cpuinfo is None:
            raise FileNotFoundError
        return cpuinfo

    monkeypatch.setattr(Path, "read_text", read_text)
    monkeypatch.setattr(hardware.platform, "processor", lambda: "")
    monkeypatch.setattr(hardware.platform, "machine", lambda: "machine")
    assert processor_name() == name
