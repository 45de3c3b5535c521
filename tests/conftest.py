"""Which tests one process does: those of a file share what they make, those of the workflow its runs."""

import pytest
from xdist.scheduler import LoadScopeScheduling


class ByFile(LoadScopeScheduling):
    """Spreads the files of tests/unit over the processes; any other folder is one process's."""

    def _split_scope(self, nodeid: str) -> str:
        path, _, _ = nodeid.partition("::")
        _, folder, *_ = path.split("/")
        return path if folder == "unit" else folder


def pytest_xdist_make_scheduler(config: pytest.Config, log) -> LoadScopeScheduling:
    """What xdist asks for the way to spread tests."""
    return ByFile(config, log)
