"""Sets and integers as bits, for weight files."""

import numpy as np
import torch
from torch import Tensor


def pack_bits(values: Tensor) -> Tensor:
    """Pack (n,) bool into (⌈n / 8⌉,) uint8, the first value lowest."""
    return torch.from_numpy(np.packbits(values.cpu().numpy(), bitorder="little"))


def unpack_bits(packed: Tensor, count: int) -> Tensor:
    """Unpack `count` bools of `pack_bits`; ValueError for another size."""
    if packed.dtype != torch.uint8 or packed.shape != (-(-count // 8),):
        raise ValueError(f"{tuple(packed.shape)} {packed.dtype} packed bits, not {count}")
    bits = np.unpackbits(packed.numpy(), count=count, bitorder="little")
    return torch.from_numpy(bits.astype(bool))


def pack_integers(values: np.ndarray, bits: int) -> Tensor:
    """Pack integers in [0, 2^bits) of any shape: (⌈n bits / 8⌉,) uint8."""
    values = values.reshape(-1)
    planes = np.stack([(values >> bit & 1).astype(bool) for bit in range(bits)], axis=1)
    return pack_bits(torch.from_numpy(planes.reshape(-1)))


def unpack_integers(packed: Tensor, bits: int, count: int) -> np.ndarray:
    """Unpack `count` integers of `pack_integers`, (count,) int64; ValueError for another size."""
    planes = unpack_bits(packed, count * bits).view(count, bits).numpy()
    return sum(planes[:, bit].astype(np.int64) << bit for bit in range(bits))
