"""Choice of device and number format by the machine."""

import os
import subprocess
import sys

import pytest
import torch

from neural_shadows.errors import InputError
from neural_shadows.networks import compute
from neural_shadows.networks.compute import choose_device, choose_dtype, is_native
from neural_shadows.running.module_graph import PACKAGE


@pytest.mark.parametrize("native", [True, False])
def test_automatic_choices(monkeypatch, native):
    """A GPU that only emulates bfloat16 says that it supports it, unless asked further."""
    monkeypatch.setattr(torch.cuda, "is_available", lambda: native)
    monkeypatch.setattr(torch.cuda, "is_bf16_supported", lambda including_emulation=True: native)
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: {"amx_bf16": native})
    monkeypatch.setattr(compute, "_used_by_onednn", lambda dtype: True)
    assert choose_device("auto").type == ("cuda" if native else "cpu")
    for device in ("cpu", "cuda"):
        expected = torch.bfloat16 if native else torch.float32
        assert choose_dtype("auto", torch.device(device)) == expected


@pytest.mark.parametrize(
    ("name", "expected"), [("znver4", torch.bfloat16), ("emeraldrapids", torch.float32)]
)
def test_formats_slower_than_float32_are_not_chosen(monkeypatch, name, expected):
    """Where AMX is hidden; who asks for it gets it."""
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: {"avx512_bf16": True})
    monkeypatch.setattr(compute, "_used_by_onednn", lambda dtype: True)
    monkeypatch.setattr(compute, "get_host_cpu_name", lambda: name)
    assert choose_dtype("auto", CPU) == expected
    assert choose_dtype("bfloat16", CPU) == torch.bfloat16


CPU, FORMATS = torch.device("cpu"), ("float32", "bfloat16", "float16")
ASKED = f"""
import torch
from neural_shadows.networks.compute import is_native
print(*(is_native(getattr(torch, name), torch.device("cpu")) for name in {FORMATS}))
"""


@pytest.mark.parametrize(
    ("capabilities", "native"),
    [
        ({"avx2": True}, ["float32"]),
        ({"avx512_bf16": True, "avx512_fp16": False}, ["float32", "bfloat16"]),
        ({"amx_bf16": True, "amx_fp16": True}, [*FORMATS]),
        ({"architecture": "aarch64", "bf16": True}, ["float32", "bfloat16"]),
    ],
)
def test_formats_without_instructions_are_refused(monkeypatch, capabilities, native):
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: capabilities)
    monkeypatch.setattr(compute, "_used_by_onednn", lambda dtype: True)
    assert [name for name in FORMATS if is_native(getattr(torch, name), CPU)] == native
    for name in FORMATS:
        if name in native:
            assert choose_dtype(name, CPU) == getattr(torch, name)
        else:
            with pytest.raises(InputError, match=f"precision: {name}: this CPU has no instr.*auto"):
                choose_dtype(name, CPU)


def test_formats_forbidden_to_onednn_are_not_native():
    """By a variable of its own, which it reads once: whatever the processor has."""
    if torch.cpu.get_capabilities()["architecture"] != "x86_64":
        pytest.skip("the variable is for x86-64")
    environment = os.environ | {"ONEDNN_MAX_CPU_ISA": "AVX2", "PYTHONPATH": str(PACKAGE.parent)}
    command = [sys.executable, "-c", ASKED]
    limited = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert limited.stdout.split() == ["True", "False", "False"]


def test_a_missing_gpu_is_refused(monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with pytest.raises(InputError, match="device: cuda.*Set device: auto or cpu"):
        choose_device("cuda")
