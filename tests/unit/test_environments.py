"""The lists of dependencies agree, and the lock is complete and the same on every machine."""

import re
from pathlib import Path

import pytest
import yaml

ENVS = Path(__file__).parents[2] / "envs"


def lines_of(name: str) -> list[str]:
    """Lines of a requirements file without comments and this project itself."""
    lines = (line.split("#")[0].strip() for line in (ENVS / name).read_text().splitlines())
    return [line for line in lines if line not in ("", "-e .")]


DIRECT = sorted(lines_of("requirements.in"))
LOCKED = lines_of("requirements.txt")


def test_conda_has_the_same_direct_pins_and_pythons():
    environment = yaml.safe_load((ENVS / "environment.yaml").read_text())
    assert environment["channels"] == ["conda-forge", "nodefaults"]
    python, other, pip = environment["dependencies"]
    pyproject = (ENVS.parent / "pyproject.toml").read_text()
    assert python == "python" + re.search(r'requires-python = "([^"]+)"', pyproject)[1]
    assert other == "pip"  # conda warns where pip is used but not listed
    assert sorted(pip["pip"]) == DIRECT


def test_the_lock_pins_everything_and_has_the_direct_pins():
    for line in LOCKED:
        # A marker after `;` says on which systems or Pythons the pin holds.
        assert re.fullmatch(r"[a-z0-9-]+==[a-z0-9.]+( ; .+)?", line), line
    assert {*DIRECT} < {*LOCKED}


def test_files_of_the_lock_are_checked_by_hash():
    """By .ci/run. pip then wants one of each package, of what torch's GPU builds need too."""
    others = r"(nvidia|cuda|triton)[^=]*==.+ ; .*sys_platform == 'linux'.*"
    pins = []
    for pin in (ENVS / "hashes.txt").read_text().replace("\\\n", "").splitlines()[2:]:
        name, *hashes = pin.split(" --hash=")
        assert hashes and all(re.fullmatch("sha256:[0-9a-f]{64} *", each) for each in hashes), pin
        pins.append(name.strip())
    assert [pin for pin in pins if not re.fullmatch(others, pin)] == LOCKED


def test_the_lock_lets_a_machine_without_a_gpu_do_without_cuda():
    """What torch's builds for GPUs need is 4.7 GB; a CPU build that is installed before is kept."""
    assert [line for line in LOCKED if re.match("nvidia-|cuda-|triton", line)] == []


@pytest.mark.parametrize("name", ["browser.txt", "external.txt", "slurm.txt"])
def test_what_few_need_is_pinned_and_no_part_of_the_lock(name):
    locked = {line.split("==")[0] for line in LOCKED}
    for line in lines_of(name):
        package, version = line.split("==")
        assert version and package not in locked


@pytest.mark.parametrize("path", sorted(ENVS.iterdir()), ids=lambda path: path.name)
def test_no_index_address(path):
    text = path.read_text()
    assert not re.search(r"://|--(extra-)?index-url|--find-links|--trusted-host| @ ", text)
