"""Which device and number format the networks compute in."""

import torch

from neural_shadows.errors import InputError


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


def choose_dtype(precision: str, device: torch.device) -> torch.dtype:
    """The number format of matrix products for `auto`, `float32`, `bfloat16` or `float16`.

    `auto` takes bfloat16 where the processor multiplies it natively (AMX or AVX-512 BF16,
    4 times as fast as float32, or a GPU that has it) and float32 elsewhere, where bfloat16
    would be emulated and slower. float16 is the thesis's (tiny-cuda-nn's). On a network of 8
    million samples bfloat16 moved depths by 0.0014 sphere radii (median) and flipped 0.13 % of the
    points that face the light, float16 by 0.00015 and 0.016 %
    (`tests/benchmarks/precision_of_queries.py`).
    """
    if precision != "auto":
        return getattr(torch, precision)
    if device.type == "cuda":
        native = torch.cuda.is_bf16_supported(including_emulation=False)
    else:
        capabilities = torch.cpu.get_capabilities()
        native = capabilities.get("amx_bf16", False) or capabilities.get("avx512_bf16", False)
    return torch.bfloat16 if native else torch.float32
