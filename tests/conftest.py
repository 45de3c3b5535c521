"""Which tests one process does, and when: those of a file share what they make."""

import os

import pytest
from checkout import KERNELS
from xdist.scheduler import LoadScopeScheduling

from neural_shadows.running import kernel_cache

os.environ[kernel_cache.VARIABLE] = str(KERNELS)


class ByFile(LoadScopeScheduling):
    """Spreads the files of the suite over the processes; a folder of long tests is one process's."""

    def _split_scope(self, nodeid: str) -> str:
        path, _, _ = nodeid.partition("::")
        _, folder, *_ = path.split("/")
        return path if folder in ("unit", "workflow") else folder


def pytest_xdist_make_scheduler(config: pytest.Config, log) -> LoadScopeScheduling:
    """What xdist asks for the way to spread tests."""
    return ByFile(config, log)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The smoke run first, beside the units, then what changes copies of it.

    The last units are short, so that no process waits for the other at the end.
    """

    def turn(item: pytest.Item) -> int:
        path = item.nodeid.partition("::")[0]
        if "/workflow/" in path:
            return 0 if path.endswith("test_smoke.py") else 2
        return 1 if path < "tests/unit/s" else 3

    items.sort(key=turn)
