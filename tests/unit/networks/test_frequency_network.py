"""The thesis's network: sizes, float64 formula, initialisation."""

import numpy as np
import pytest
import torch
from rays import ball_batch

from neural_shadows.networks.object_space.frequency_network import (
    FrequencyEncoding,
    FrequencyNetwork,
)

WIDTHS = (256, 128, 64)  # of the thesis [4.4.2]
RAYS = ball_batch(256)[:2]


def thesis_network(width: int, seed: int = 0) -> FrequencyNetwork:
    network = FrequencyNetwork(frequencies=10, width=width, hidden_layers=8)
    network.initialise(seed)
    return network


@pytest.mark.parametrize(("width", "count"), [(256, 556_800), (128, 147_328), (64, 40_896)])
def test_parameter_counts_of_the_thesis(width, count):
    """In memory each is a float32, beside the encoding's ten factors."""
    network = thesis_network(width)
    assert network.parameter_count() == count
    assert network.resident_bytes() == 4 * (count + 10)


def test_encoding_against_float64():
    assert FrequencyEncoding(0).size == 6
    x = torch.rand(2048, 6, generator=torch.Generator().manual_seed(0))
    encoding = FrequencyEncoding(10)
    encoded = encoding(x).double().numpy()
    assert np.array_equal(encoded[:, :6], x.numpy())
    assert encoded.shape == (2048, 126) and encoding.size == 126

    phase = np.pi * 2.0 ** np.arange(10) * x.double().numpy()[:, :, None]
    error = np.abs(encoded[:, 6:] - np.hstack([np.sin(phase), np.cos(phase)]).reshape(2048, -1))
    error = error.reshape(2048, 2, 6, 10).max(axis=(0, 1, 2))
    # A phase of up to 2^k π is rounded to a spacing of 2^(k+1) 2^-23, and float32's π is off
    # by 3e-8 of itself: together at most 4e-7 · 2^k, which is 2e-4 at the highest frequency.
    assert (error < 4e-7 * 2.0 ** np.arange(10)).all()


@pytest.mark.parametrize("width", WIDTHS)
def test_no_seed_starts_without_output(width):
    means = []
    for seed in range(64):
        with torch.inference_mode():
            half = thesis_network(width, seed)(*RAYS, torch.float32) / 2
        assert half.min() > 0  # every ray has a gradient, not just the mean
        means.append(half.mean().item())
    assert 0.1 < min(means) and max(means) < 1.2
    assert np.mean(means) == pytest.approx(0.47, abs=0.1)
