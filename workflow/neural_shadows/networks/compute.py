"""Which device and number format the networks compute in."""

import torch
from llvmlite.binding import get_host_cpu_name

from neural_shadows.errors import InputError

# What a CPU's instructions for matrix products of 16 bits are called, of x86-64 and of ARM.
_INSTRUCTIONS = {
    torch.bfloat16: ("amx_bf16", "avx512_bf16", "bf16"),
    torch.float16: ("amx_fp16", "avx512_fp16", "fp16_arith"),
}


def choose_device(device: str) -> torch.device:
    """The torch device for `auto`, `cpu` or `cuda`; `auto` takes a GPU where there is one.

    Raises:
        InputError: `cuda` was asked for and there is none.
    """
    if device == "auto":
        device = "cuda" if torch.cuda.is_available() else "cpu"
    if device == "cuda" and not torch.cuda.is_available():
        raise InputError("device: cuda, but torch finds no CUDA GPU; set device: auto or cpu")
    return torch.device(device)


def is_native(dtype: torch.dtype, device: torch.device) -> bool:
    """Whether a device multiplies matrices of a number format by instructions of its own.

    Elsewhere the format is emulated: bfloat16 with AVX2 alone at 0.5 to 1.6 GMAC/s of a core, where
    float32 has 30. Of a CPU both count, what it has and what oneDNN, which multiplies, makes use of.
    """
    if dtype == torch.float32:
        return True
    if device.type == "cuda":
        return dtype == torch.float16 or torch.cuda.is_bf16_supported(including_emulation=False)
    capabilities = torch.cpu.get_capabilities()
    has = any(capabilities.get(name, False) for name in _INSTRUCTIONS[dtype])
    return has and _used_by_onednn(dtype)


def _used_by_onednn(dtype: torch.dtype) -> bool:
    """Whether oneDNN would take them: ONEDNN_MAX_CPU_ISA may forbid it, some builds lack oneDNN."""
    if not torch.backends.mkldnn.is_available():
        return False
    if dtype == torch.bfloat16:
        return torch.ops.mkldnn._is_mkldnn_bf16_supported()
    return torch.ops.mkldnn._is_mkldnn_fp16_supported()


def _is_faster(device: torch.device) -> bool:
    """Whether a device multiplies in bfloat16, which it has, faster than in float32.

    A GPU does, and so do AMX and, by AVX-512 BF16, AMD's processors (4 times as fast). Intel's whose
    AMX a virtual machine hides have AVX-512 BF16 as well and are half as fast by it: 26 and 50 GMAC/s
    of a core, a step of training 1.45 times as long. It goes by names: to time two products beside
    other work told either, and a training that goes on must have the format that it began with.
    """
    has = torch.cpu.get_capabilities()
    slow = has.get("avx512_bf16") and not has.get("amx_bf16")
    return device.type == "cuda" or not slow or get_host_cpu_name().startswith("znver")


def choose_dtype(precision: str, device: torch.device) -> torch.dtype:
    """The number format of matrix products for `auto`, `float32`, `bfloat16` or `float16`.

    `auto` takes bfloat16 where the processor has it and is faster by it than by float32, which it
    takes elsewhere. float16 is the thesis's (tiny-cuda-nn's). On a network of 8 million samples
    bfloat16 moved depths by 0.0014 sphere radii (median) and flipped 0.13 % of the points that face
    the light, float16 by 0.00015 and 0.016 %.

    Raises:
        InputError: the device has to emulate the format that was asked for.
    """
    if precision == "auto":
        wanted = torch.bfloat16
        faster = is_native(wanted, device) and _is_faster(device)
        return wanted if faster else torch.float32
    dtype = getattr(torch, precision)
    if not is_native(dtype, device):
        raise InputError(
            f"precision: {precision}: this {'GPU' if device.type == 'cuda' else 'CPU'} has no "
            "instructions for it, and would emulate it 20 times as slowly as float32; set precision: "
            "auto or float32"
        )
    return dtype
