"""How much the corpus tries, and what one input may take."""

import resource
import signal

import pytest
from hypothesis import HealthCheck, settings

COMMON = {"deadline": None, "database": None, "suppress_health_check": list(HealthCheck)}
settings.register_profile("short", max_examples=25, derandomize=True, **COMMON)
settings.register_profile("full", max_examples=500, print_blob=True, **COMMON)

# Of one test: a damaged file may ask for terabytes, and readers in native code may hang.
SECONDS, BYTES = 120, 12 * 2**30


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("hypothesis_profile", None) is None:
        settings.load_profile("short")


@pytest.fixture(autouse=True)
def bounded():
    def too_slow(*_):
        pytest.fail(f"took more than {SECONDS} s")

    limits = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, limits[1]))
    signal.signal(signal.SIGALRM, too_slow)
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)
    resource.setrlimit(resource.RLIMIT_AS, limits)
