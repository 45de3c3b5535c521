"""Devices and number formats are those of the machine, and wrong wishes are refused."""

import pytest
import torch

from neural_shadows.errors import InputError
from neural_shadows.networks.compute import choose_device, choose_dtype

BFLOAT16, FLOAT32 = torch.bfloat16, torch.float32


@pytest.mark.parametrize("gpu", [True, False])
def test_device(monkeypatch, gpu):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: gpu)
    assert choose_device("auto").type == ("cuda" if gpu else "cpu")
    assert choose_device("cpu").type == "cpu"
    if not gpu:
        with pytest.raises(InputError, match="device: cuda.*set device: auto or cpu"):
            choose_device("cuda")


@pytest.mark.parametrize(
    ("capabilities", "dtype"),
    [
        ({"avx512_bf16": True}, BFLOAT16),
        ({"amx_bf16": True}, BFLOAT16),
        ({"amx_bf16": False, "avx512_bf16": False, "avx512_f": True}, FLOAT32),
        ({}, FLOAT32),  # another architecture
    ],
)
def test_automatic_dtype_of_a_cpu(monkeypatch, capabilities, dtype):
    if torch.cpu.get_capabilities().get("architecture") == "x86_64":  # the names are torch's
        assert {"amx_bf16", "avx512_bf16"} <= torch.cpu.get_capabilities().keys()
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: capabilities)
    assert choose_dtype("auto", torch.device("cpu")) == dtype
    assert choose_dtype("bfloat16", torch.device("cpu")) == BFLOAT16


@pytest.mark.parametrize(("native", "dtype"), [(True, BFLOAT16), (False, FLOAT32)])
def test_automatic_dtype_of_a_gpu(monkeypatch, native, dtype):
    """A GPU that only emulates bfloat16 says that it supports it, unless asked further."""

    def supported(including_emulation=True):
        return including_emulation or native

    monkeypatch.setattr(torch.cuda, "is_bf16_supported", supported)
    assert choose_dtype("auto", torch.device("cuda")) == dtype
