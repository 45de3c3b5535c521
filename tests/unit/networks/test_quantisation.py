"""What fewer bits keep of weights, and that sets of bits come back whole."""

import pytest
import torch

from neural_shadows.networks.quantisation import pack_bits, quantise, restore_values, unpack_bits


@pytest.fixture
def tensors():
    generator = torch.Generator().manual_seed(0)
    return {
        "a": torch.randn(50, 3, generator=generator),
        "b.bias": 1e-3 * torch.randn(7, generator=generator),
        "nothing": torch.zeros(4),
    }


@pytest.mark.parametrize(
    ("storage", "bytes_each", "error"), [("float32", 4, 0), ("float16", 2, 2**-11)]
)
def test_floats_keep_their_digits(tensors, storage, bytes_each, error):
    stored = quantise(tensors, storage)
    assert {name: value.nbytes for name, value in stored.items()} == {
        name: bytes_each * value.numel() for name, value in tensors.items()
    }
    for name, value in restore_values(stored, storage).items():
        assert value.dtype == torch.float32
        assert (value - tensors[name]).abs().le(error * tensors[name].abs() + 1e-7).all()


def test_int8_is_off_by_half_a_step_at_most(tensors):
    stored = quantise(tensors, "int8")
    assert sum(value.nbytes for value in stored.values()) == 150 + 7 + 4 + 3 * 4
    for name, value in restore_values(stored, "int8").items():
        step = tensors[name].abs().max() / 127
        assert (value - tensors[name]).abs().max() <= step / 2 * 1.001
    again = quantise(restore_values(stored, "int8"), "int8")
    assert all(torch.equal(again[name], stored[name]) for name in ("a", "b.bias"))


@pytest.mark.parametrize("count", [0, 1, 8, 9, 1000])
def test_bits_come_back(count):
    bits = torch.rand(count, generator=torch.Generator().manual_seed(count)) < 0.3
    packed = pack_bits(bits)
    assert packed.dtype == torch.uint8 and len(packed) == -(-count // 8)
    assert torch.equal(unpack_bits(packed, count), bits)
    with pytest.raises(ValueError, match="packed bits"):
        unpack_bits(packed, count + 8)
