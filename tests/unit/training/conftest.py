from itertools import cycle
from types import SimpleNamespace

import pytest
import torch

from neural_shadows.running import cores
from neural_shadows.training import workers


@pytest.fixture(autouse=True)
def keep_threads():
    before = torch.get_num_threads()
    yield
    torch.set_num_threads(before)


@pytest.fixture
def idle(monkeypatch):
    """Set how many cores the job has at each look, again and again."""

    def set_to(*counts: int) -> None:
        told = cycle(counts)
        job = SimpleNamespace(take_idle=lambda run_cores, most: next(told))
        monkeypatch.setattr(workers, "LOOK_SECONDS", 0.0)
        monkeypatch.setattr(cores, "JOB", job)

    return set_to
