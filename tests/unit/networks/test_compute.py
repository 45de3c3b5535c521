"""Devices and number formats are those of the machine, and wrong wishes are refused."""

import pytest
import torch

from neural_shadows.errors import InputError
from neural_shadows.networks.compute import choose_device, choose_dtype


@pytest.mark.parametrize("native", [True, False])
def test_automatic_choices(monkeypatch, native):
    """A GPU that only emulates bfloat16 says that it supports it, unless asked further."""
    monkeypatch.setattr(torch.cuda, "is_available", lambda: native)
    monkeypatch.setattr(torch.cuda, "is_bf16_supported", lambda including_emulation=True: native)
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: {"amx_bf16": native})
    assert choose_device("auto").type == ("cuda" if native else "cpu")
    for device in ("cpu", "cuda"):
        wanted = torch.bfloat16 if native else torch.float32
        assert choose_dtype("auto", torch.device(device)) == wanted
    for precision in ("float32", "bfloat16", "float16"):
        assert str(choose_dtype(precision, torch.device("cpu"))) == f"torch.{precision}"


def test_a_gpu_that_is_not_there(monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with pytest.raises(InputError, match="device: cuda.*set device: auto or cpu"):
        choose_device("cuda")
