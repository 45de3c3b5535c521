"""Options of these tests, and what they share."""

import random
import signal
from pathlib import Path

import pytest
from undisturbed import Undisturbed


def pytest_addoption(parser):
    group = parser.getgroup("faults")
    group.addoption("--full", action="store_true", help="all stages, at least 50 kills: an hour")
    group.addoption("--kills", type=Path, help="the folder that the tables of kills go to")
    group.addoption("--kill-seed", type=int, default=1, help="of the moments of kills")


@pytest.fixture(scope="session")
def full(request) -> bool:
    """Whether the whole is asked for, or the short form."""
    return request.config.getoption("--full")


@pytest.fixture
def only_full(full) -> None:
    """For a test that is no part of the short form."""
    if not full:
        pytest.skip("only with --full")


@pytest.fixture
def moments(request) -> random.Random:
    """What the moments of kills are drawn from."""
    return random.Random(request.config.getoption("--kill-seed"))


@pytest.fixture(scope="session")
def undisturbed(full, tmp_path_factory) -> Undisturbed:
    """A finished run; it must be left as it is."""
    return Undisturbed.run(tmp_path_factory.mktemp("undisturbed"), full)


@pytest.fixture(scope="session", autouse=True)
def interruptible():
    """Started in the background, pytest and all its children would ignore Ctrl-C."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
