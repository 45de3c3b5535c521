"""Device and number format of the networks."""

import time

import torch
from llvmlite.binding import get_host_cpu_name

from neural_shadows.errors import InputError

# Names of a CPU's instructions for 16-bit matrix products, x86-64 and ARM.
_INSTRUCTIONS = {
    torch.bfloat16: ("amx_bf16", "avx512_bf16", "bf16"),
    torch.float16: ("amx_fp16", "avx512_fp16", "fp16_arith"),
}


def choose_device(device: str) -> torch.device:
    """Torch device for `auto`, `cpu` or `cuda`; `auto` prefers a GPU.

    Raises:
        InputError: `cuda` without a CUDA GPU.
    """
    if device == "auto":
        device = "cuda" if torch.cuda.is_available() else "cpu"
    if device == "cuda" and not torch.cuda.is_available():
        raise InputError("device: cuda: torch finds no CUDA GPU. Set device: auto or cpu.")
    return torch.device(device)


def finished(device: torch.device) -> float:
    """Seconds on a clock, once all work on the device is done."""
    if device.type == "cuda":
        torch.cuda.synchronize(device)
    return time.perf_counter()


def is_native(dtype: torch.dtype, device: torch.device) -> bool:
    """Test a device for native matrix products in a format.

    Elsewhere the format is emulated: bfloat16 with AVX2 alone at 0.5 to 1.6 GMAC/s a core, where
    float32 has 30. On a CPU both the processor and oneDNN must support the instructions.
    """
    if dtype == torch.float32:
        return True
    if device.type == "cuda":
        return dtype == torch.float16 or torch.cuda.is_bf16_supported(including_emulation=False)
    capabilities = torch.cpu.get_capabilities()
    supported = any(capabilities.get(name, False) for name in _INSTRUCTIONS[dtype])
    return supported and _used_by_onednn(dtype)


def _used_by_onednn(dtype: torch.dtype) -> bool:
    """Test oneDNN for support: ONEDNN_MAX_CPU_ISA may forbid it, some builds lack it."""
    if not torch.backends.mkldnn.is_available():
        return False
    if dtype == torch.bfloat16:
        return torch.ops.mkldnn._is_mkldnn_bf16_supported()
    return torch.ops.mkldnn._is_mkldnn_fp16_supported()


def _is_faster(device: torch.device) -> bool:
    """Test for native bfloat16 products faster than float32.

    True on GPUs, with AMX, and with AVX-512 BF16 on AMD (4 times as fast). Intel CPUs whose AMX a
    virtual machine hides have AVX-512 BF16 too, but it is half as fast as float32: 26 and 50 GMAC/s
    a core, a training step 1.45 times as long. Decided by names: timing two products beside other
    work was unreliable, and a resumed training must keep its format.
    """
    capabilities = torch.cpu.get_capabilities()
    slow = capabilities.get("avx512_bf16") and not capabilities.get("amx_bf16")
    return device.type == "cuda" or not slow or get_host_cpu_name().startswith("znver")


def choose_dtype(precision: str, device: torch.device) -> torch.dtype:
    """Number format of matrix products: `auto`, `float32`, `bfloat16` or `float16`.

    `auto` takes bfloat16 where it is native and faster than float32, else float32. float16 is the
    thesis's (tiny-cuda-nn's). On a network of 8 million samples bfloat16 moved depths by 0.0014
    sphere radii (median) and flipped 0.13 % of the points that face the light, float16 by 0.00015
    and 0.016 %.

    Raises:
        InputError: the device would emulate the format.
    """
    if precision == "auto":
        faster = is_native(torch.bfloat16, device) and _is_faster(device)
        return torch.bfloat16 if faster else torch.float32
    dtype = getattr(torch, precision)
    if not is_native(dtype, device):
        raise InputError(
            f"precision: {precision}: this {'GPU' if device.type == 'cuda' else 'CPU'} has no "
            "instructions for it; emulation is 20 times slower than float32. Set precision: auto or "
            "float32."
        )
    return dtype
