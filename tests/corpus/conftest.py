"""How much the corpus tries, and the table of what it tried."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings
from trial import Trials

# What the readers take is bounded in their own process.
COMMON = {"deadline": None, "database": None, "suppress_health_check": list(HealthCheck)}
settings.register_profile("short", max_examples=15, derandomize=True, **COMMON)
settings.register_profile("full", max_examples=400, print_blob=True, **COMMON)

ENDS = pytest.StashKey[Trials]()


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("hypothesis_profile", None) is None:
        settings.load_profile("short")


@pytest.fixture(scope="session")
def trials(request, tmp_path_factory) -> Iterator[Trials]:
    """Readers in a process of their own, and the count of what they were given."""
    if not Path("/proc/self/clear_refs").exists():
        pytest.skip("what a reader takes is measured by Linux's /proc")
    trials = request.config.stash[ENDS] = Trials(tmp_path_factory.mktemp("corpus"))
    yield trials
    trials.close()


def pytest_terminal_summary(terminalreporter, config: pytest.Config) -> None:
    """Print how many inputs of each kind each reader was given, and how they ended."""
    trials = config.stash.get(ENDS, None)
    if trials is None:
        return
    terminalreporter.section("corpus: inputs by how reading them ended")
    terminalreporter.write_line(trials.table())
