import pytest
import torch

from neural_shadows.networks import compute


@pytest.fixture(autouse=True)
def keep_threads():
    before = torch.get_num_threads()
    yield
    torch.set_num_threads(before)


@pytest.fixture
def any_format(monkeypatch):
    """Formats that this machine's processor lacks are emulated, as tiny networks can afford."""
    monkeypatch.setattr(compute, "is_native", lambda dtype, device: True)
