"""What fewer bits keep of weights, and that sets of bits come back whole."""

import pytest
import torch

from neural_shadows.networks.quantisation import pack_bits, quantise, restore_values, unpack_bits


@pytest.mark.parametrize(
    ("storage", "size", "relative", "of_largest"),
    [
        ("float32", 4 * 161, 0, 0),
        ("float16", 2 * 161, 2**-11, 1e-6),
        ("int8", 161 + 3 * 4, 0, 1.001 / 254),  # half a step
    ],
)
def test_values_come_back_to_the_digits_of_their_storage(storage, size, relative, of_largest):
    generator = torch.Generator().manual_seed(0)
    tensors = {
        "a": torch.randn(50, 3, generator=generator),
        "b.bias": 1e-3 * torch.randn(7, generator=generator),
        "nothing": torch.zeros(4),
    }
    stored = quantise(tensors, storage)
    assert sum(value.nbytes for value in stored.values()) == size
    restored = restore_values(stored, storage)
    assert restored.keys() == tensors.keys()
    for name, value in restored.items():
        assert value.dtype == torch.float32
        allowed = relative * tensors[name].abs() + of_largest * tensors[name].abs().max()
        assert ((value - tensors[name]).abs() <= allowed).all()
    again = quantise(restored, storage)
    assert all(torch.equal(again[name], stored[name]) for name in ("a", "b.bias"))


@pytest.mark.parametrize("count", [0, 1, 8, 9, 1000])
def test_bits_come_back(count):
    bits = torch.rand(count, generator=torch.Generator().manual_seed(count)) < 0.3
    packed = pack_bits(bits)
    assert packed.dtype == torch.uint8 and len(packed) == -(-count // 8)
    assert torch.equal(unpack_bits(packed, count), bits)
    with pytest.raises(ValueError, match="packed bits"):
        unpack_bits(packed, count + 8)
