"""Which tests one process does: those of a file share what they make, those of the workflow its runs."""

from pathlib import Path

import pytest

TESTS = Path(__file__).parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Spread the files of tests/unit over the processes, and no other folder."""
    for item in items:
        parts = item.path.relative_to(TESTS).parts
        group = "/".join(parts) if parts[0] == "unit" else parts[0]
        item.add_marker(pytest.mark.xdist_group(group))
