"""Devices and number formats are those of the machine, and wrong wishes are refused."""

import pytest
import torch

from neural_shadows.errors import InputError
from neural_shadows.networks.compute import choose_device, choose_dtype

CPU, CUDA = torch.device("cpu"), torch.device("cuda")


@pytest.mark.parametrize(
    ("asked", "gpu", "type_"),
    [("auto", True, "cuda"), ("auto", False, "cpu"), ("cpu", True, "cpu"), ("cuda", True, "cuda")],
)
def test_device(monkeypatch, asked, gpu, type_):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: gpu)
    assert choose_device(asked).type == type_


def test_missing_gpu_is_refused(monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with pytest.raises(InputError, match="device: cuda.*set device: auto or cpu"):
        choose_device("cuda")


@pytest.mark.parametrize(
    ("capabilities", "dtype"),
    [
        ({"avx512_bf16": True}, torch.bfloat16),
        ({"amx_bf16": True}, torch.bfloat16),
        ({"amx_bf16": False, "avx512_bf16": False, "avx512_f": True}, torch.float32),
        ({}, torch.float32),  # another architecture
    ],
)
def test_automatic_dtype_of_a_cpu(monkeypatch, capabilities, dtype):
    if torch.cpu.get_capabilities().get("architecture") == "x86_64":  # the names are torch's
        assert {"amx_bf16", "avx512_bf16"} <= torch.cpu.get_capabilities().keys()
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: capabilities)
    assert choose_dtype("auto", CPU) == dtype
    assert choose_dtype("bfloat16", CPU) == torch.bfloat16


@pytest.mark.parametrize(("native", "dtype"), [(True, torch.bfloat16), (False, torch.float32)])
def test_automatic_dtype_of_a_gpu(monkeypatch, native, dtype):
    """A GPU that only emulates bfloat16 says that it supports it, unless asked further."""
    monkeypatch.setattr(
        torch.cuda,
        "is_bf16_supported",
        lambda including_emulation=True: including_emulation or native,
    )
    assert choose_dtype("auto", CUDA) == dtype
