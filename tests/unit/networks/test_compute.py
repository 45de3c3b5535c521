"""Devices and number formats are those of the machine, and wrong wishes are refused."""

import pytest
import torch

from neural_shadows.errors import InputError
from neural_shadows.networks.compute import choose_device, choose_dtype

CPU = torch.device("cpu")


@pytest.fixture
def gpu(monkeypatch):
    """Pretend that there is a GPU (True) or none (False)."""
    return lambda there: monkeypatch.setattr(torch.cuda, "is_available", lambda: there)


@pytest.mark.parametrize(
    ("asked", "there", "type_"),
    [("auto", True, "cuda"), ("auto", False, "cpu"), ("cpu", True, "cpu"), ("cuda", True, "cuda")],
)
def test_device(gpu, asked, there, type_):
    gpu(there)
    assert choose_device(asked).type == type_


def test_missing_gpu_is_refused(gpu):
    gpu(False)
    with pytest.raises(InputError, match="device: cuda.*set device: auto or cpu"):
        choose_device("cuda")


@pytest.mark.parametrize("device", [CPU, torch.device("cuda")])
def test_dtype_that_was_asked_for(device):
    assert choose_dtype("float32", device) == torch.float32
    assert choose_dtype("bfloat16", device) == torch.bfloat16


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
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: capabilities)
    assert choose_dtype("auto", CPU) == dtype


def test_torch_names_the_cpu_capabilities_as_expected():
    capabilities = torch.cpu.get_capabilities()
    if capabilities.get("architecture") != "x86_64":
        pytest.skip("the names are those of x86")
    assert {"amx_bf16", "avx512_bf16"} <= capabilities.keys()


@pytest.mark.parametrize(("native", "dtype"), [(True, torch.bfloat16), (False, torch.float32)])
def test_automatic_dtype_of_a_gpu(monkeypatch, native, dtype):
    """A GPU that only emulates bfloat16 says that it supports it, unless asked further."""
    monkeypatch.setattr(
        torch.cuda,
        "is_bf16_supported",
        lambda including_emulation=True: including_emulation or native,
    )
    assert choose_dtype("auto", torch.device("cuda")) == dtype
