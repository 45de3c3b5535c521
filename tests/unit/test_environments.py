"""The lists of dependencies agree, and the lock is complete and the same on every machine."""

import re
from pathlib import Path

import pytest
import yaml

ENVS = Path(__file__).parents[2] / "envs"


def lines_of(name: str) -> list[str]:
    """Lines of a requirements file without comments."""
    lines = (line.split("#")[0].strip() for line in (ENVS / name).read_text().splitlines())
    return [line for line in lines if line]


def pins_of(lines: list[str]) -> dict[str, str]:
    """Version by package; fails on a line that is no `name==version`."""
    pins = {}
    for line in lines:
        match = re.fullmatch(r"([A-Za-z0-9._-]+)==([A-Za-z0-9.]+)", line)
        assert match, f"{line!r} is not pinned with =="
        assert match[1] not in pins, f"{match[1]} is listed twice"
        pins[match[1]] = match[2]
    return pins


@pytest.fixture(scope="module")
def direct() -> dict[str, str]:
    lines = lines_of("requirements.in")
    assert lines.count("-e .") == 1
    return pins_of([line for line in lines if line != "-e ."])


@pytest.fixture(scope="module")
def environment() -> dict:
    return yaml.safe_load((ENVS / "environment.yaml").read_text())


def test_conda_has_the_same_direct_pins(direct, environment):
    (pip,) = [part["pip"] for part in environment["dependencies"] if isinstance(part, dict)]
    assert pins_of(pip) == direct


def test_conda_has_the_pythons_of_the_project(environment):
    assert environment["name"] == "neural-shadows"
    assert environment["channels"] == ["conda-forge", "nodefaults"]
    others = [part for part in environment["dependencies"] if isinstance(part, str)]
    (python,) = [part for part in others if part.startswith("python")]
    pyproject = (ENVS.parent / "pyproject.toml").read_text()
    supported = re.search(r'requires-python = "([^"]+)"', pyproject)[1]
    assert python == f"python{supported}"
    assert "pip" in others  # conda warns where pip is used but not listed


def test_lock_has_the_direct_pins(direct):
    locked = set(lines_of("requirements.txt"))
    for name, version in direct.items():
        assert f"{name}=={version}" in locked


def test_every_line_of_the_lock_is_a_pin():
    lines = lines_of("requirements.txt")
    lines.remove("-e .")
    assert len(lines) > 50  # with the indirect dependencies
    for line in lines:
        # A marker after `;` says on which systems or Pythons the pin holds.
        assert re.fullmatch(r"[a-z0-9-]+==[a-z0-9.]+( ; .+)?", line), line


def test_the_lock_lets_a_machine_without_a_gpu_do_without_cuda():
    """What torch's builds for GPUs need is 4.7 GB; a CPU build that is installed before is kept."""
    for line in lines_of("requirements.txt"):
        assert not re.match("nvidia-|cuda-|triton", line), line


@pytest.mark.parametrize("name", ["benchmarks.txt", "browser.txt", "slurm.txt"])
def test_what_few_need_is_no_part_of_the_lock(name):
    locked = {line.split("==")[0] for line in lines_of("requirements.txt")}
    assert not locked & pins_of(lines_of(name)).keys()


@pytest.mark.parametrize("path", sorted(ENVS.iterdir()), ids=lambda path: path.name)
def test_no_index_address(path):
    text = path.read_text()
    assert not re.search(r"://|--(extra-)?index-url|--find-links|--trusted-host| @ ", text)
