from neural_shadows.running import hardware
from neural_shadows.running.hardware import describe_machine


def test_description(tmp_path, monkeypatch):
    monkeypatch.setattr(hardware, "CPUINFO", tmp_path / "cpuinfo")
    monkeypatch.setattr(hardware.platform, "processor", lambda: "arm")
    assert describe_machine()["cpu"] == "arm"  # not Linux on x86
    (tmp_path / "cpuinfo").write_text("processor\t: 0\nmodel name\t: AMD EPYC: 9654\nMHz\t: 1\n")
    machine = describe_machine()
    # No host name, no user, no path: results are published.
    assert list(machine) == ["cpu", "cores", "gpu", "system", "python", "torch"]
    assert machine["cpu"] == "AMD EPYC: 9654"
