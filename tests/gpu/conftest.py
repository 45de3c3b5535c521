"""Without a GPU none of these tests runs: each says so."""

import pytest
import torch


@pytest.fixture(autouse=True, scope="session")
def gpu():
    if not torch.cuda.is_available():
        pytest.skip("torch finds no CUDA GPU")
