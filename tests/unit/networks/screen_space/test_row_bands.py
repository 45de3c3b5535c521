"""Networks in bands of rows: the output layer by layer, whatever the bands and threads."""

import pytest
import torch
from built_networks import make_screen_network

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space import row_bands

FOUR = ["c_e", "view", "ratio", "difference"]
EIGHT = ["cosine", "c_v_by_d", "z_f", "penumbra", "behind", "z_b_by_z", "z_b", "base_msm"]
NETWORKS = {
    "full": {"form": "full", "widths": [8, [16, 8], 32], "features": FOUR, "first_skip": True},
    "extraction": {"form": "full", "widths": [8, 16], "features": FOUR, "extraction": 8},
    "shuffle": {"form": "shuffle", "widths": [8, 16, 32], "features": FOUR},
    "half": {"form": "half", "widths": [8, 16], "features": FOUR},
    "original": {"form": "original", "widths": [8, 16, 32], "features": FOUR},
    "exponent": {
        **{"form": "shuffle", "widths": [8, 16], "features": [*FOUR, "behind"]},
        "answer": "exponent",
    },
    "kernels": {"form": "kernels", "widths": [8, 8, 16], "features": EIGHT, "filters": 3},
    "full ends": {"form": "kernels", "widths": [8, 8], "features": EIGHT, "ends": "full"},
    "direct": {"form": "direct", "widths": [8, 8, 16], "features": FOUR},
}


def build(name, dtype=torch.float32):
    network = make_screen_network(NETWORKS[name])
    return network.for_inference().in_format(dtype)


def planes(network, *size):
    generator = torch.Generator().manual_seed(2)
    return torch.rand(size[0], channels_of(network.features), *size[1:], generator=generator)


@pytest.mark.parametrize("name", NETWORKS)
@pytest.mark.parametrize("size", [(1, 150, 70), (2, 13, 21), (1, 5, 3)])
def test_bands_give_the_output_of_whole_layers(name, size):
    network = build(name)
    x = planes(network, *size)
    with torch.inference_mode():
        expected = network(x)
    scale = max(1, float(expected.abs().max()))
    assert (network.in_bands(x) - expected).abs().max() < 1e-5 * scale


@pytest.mark.parametrize("name", ["shuffle", "kernels"])
def test_in_bfloat16_up_to_its_rounding(name):
    network = build(name, torch.bfloat16)
    x = planes(network, 1, 70, 40)
    with torch.inference_mode():
        expected = network(x)
    assert network.in_bands(x).dtype == expected.dtype
    assert (network.in_bands(x) - expected).abs().max() < 0.02


@pytest.mark.parametrize("name", ["shuffle", "direct", "kernels"])
@pytest.mark.parametrize("rows", [2, 64])
def test_the_output_is_that_of_other_bands(name, rows, monkeypatch):
    network = build(name)
    x = planes(network, 1, 96, 40)
    expected = network.in_bands(x)
    monkeypatch.setattr(row_bands, "ROWS", rows)
    assert torch.allclose(network.in_bands(x), expected, atol=1e-5)


@pytest.mark.parametrize("name", ["shuffle", "kernels"])
def test_the_output_does_not_depend_on_threads(name):
    network, before = build(name), torch.get_num_threads()
    x = planes(network, 1, 200, 40)
    outputs = []
    try:
        for threads in (1, 2, 3):
            torch.set_num_threads(threads)
            outputs.append(network.in_bands(x))
            assert torch.get_num_threads() == threads
    finally:
        torch.set_num_threads(before)
    assert all(torch.equal(output, outputs[0]) for output in outputs)


def test_a_module_without_rows_is_refused():
    with pytest.raises(TypeError, match="Tanh has no form by rows"):
        row_bands.through(torch.nn.Tanh(), row_bands.stored(torch.zeros(1, 1, 2, 2)))
