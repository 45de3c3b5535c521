"""Runs of the workflow that tests share; each is made once and must be left as it is."""

import fcntl
from dataclasses import replace

import pytest
from checkout import Checkout


@pytest.fixture(scope="session")
def fresh(tmp_path_factory) -> Checkout:
    """A checkout in which nothing has run."""
    return Checkout.fresh(tmp_path_factory.mktemp("fresh"))


@pytest.fixture(scope="session")
def smoke(fresh, tmp_path_factory, worker_id) -> Checkout:
    """The smoke workflow, run to its end without a disturbance; `said` is what it said.

    By the first process that needs it: another waits for its end.
    """
    own = tmp_path_factory.getbasetemp()
    folder = (own if worker_id == "master" else own.parent) / "smoke"
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "said").exists():
            (folder / "said").write_text(fresh.copy(folder).run(), encoding="utf-8")
    return replace(fresh, folder=folder)


@pytest.fixture
def finished(smoke, tmp_path) -> Checkout:
    """A copy of the finished smoke run, for a test to change."""
    return smoke.copy(tmp_path / "checkout")
