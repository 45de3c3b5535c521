"""One thread of PyTorch's: on two cores two processes of two make a test of 2 s one of 28."""

import pytest
import torch

from neural_shadows.networks import compute

torch.set_num_threads(1)


@pytest.fixture
def any_format(monkeypatch):
    """Formats that this machine's processor lacks are emulated, as tiny networks can afford."""
    monkeypatch.setattr(compute, "is_native", lambda dtype, device: True)
