"""Runs of the workflow that tests share; each is made once and must be left as it is."""

import pytest
from checkout import Checkout


@pytest.fixture(scope="session")
def fresh(tmp_path_factory) -> Checkout:
    """A checkout in which nothing has run."""
    return Checkout.fresh(tmp_path_factory.mktemp("fresh"))


@pytest.fixture(scope="session")
def smoke(fresh, tmp_path_factory) -> Checkout:
    """The smoke workflow, run to its end without a disturbance; `said` is what it said."""
    checkout = fresh.copy(tmp_path_factory.mktemp("smoke"))
    checkout.folder.joinpath("said").write_text(checkout.run(), encoding="utf-8")
    return checkout


@pytest.fixture
def finished(smoke, tmp_path) -> Checkout:
    """A copy of the finished smoke run, for a test to change."""
    return smoke.copy(tmp_path / "checkout")
