"""Counts of Datta et al. 2022 against the networks' own."""

import functools

import pytest
from built_networks import make_screen_network
from counted import counted
from shipped import shipped

from neural_shadows.networks.screen_space.widths import by_level, convolutions, total

PIXELS = 2048 * 1024
# weights without biases, multiply-adds a pixel: tables S2, S4, S5, and implied (spec 2.2 to 2.4)
COUNTS = {
    "layers_3": (39_248, 8_528),
    "trimmed": (653_648, 16_208),
    "layers_7": (9_501_008, 21_968),
    "layers_3_equal": (110_928, 14_928),
    "layers_7_equal": (1_626_448, 15_328),
    "nsm": (649_856, 12_704),
    "original": (7_756_960, 184_480),
    "extraction": (653_648 + 304, 16_208 + 304),
}
# table S2: GMAC, thousands of weights, storage in millions, by level
TABLE_S2 = [
    (7.15, 3.4, 278.9),
    (8.05, 15.4, 117.4),
    (8.05, 61.4, 58.7),
    (8.05, 245.8, 29.3),
    (2.68, 327.68, 6.29),
]


@functools.cache
def layers_of(name):
    settings = shipped()["networks"][name]
    channels = 15 if name == "extraction" else 4
    layers = convolutions(
        settings["form"], settings["widths"], channels, settings.get("extraction")
    )
    return make_screen_network(settings), layers


@pytest.mark.parametrize("name", COUNTS)
def test_weights_and_multiply_adds_are_the_paper_s(name):
    network, layers = layers_of(name)
    channels = 15 if name == "extraction" else 4
    assert counted(network, channels) == COUNTS[name]
    assert (total(layers, "weights"), total(layers, "macs")) == COUNTS[name]


def test_levels_are_those_of_table_s2():
    _, layers = layers_of("trimmed")
    for level, (compute, weights, storage) in enumerate(TABLE_S2):
        result = {what: by_level(layers, what)[level] for what in ("macs", "weights", "storage")}
        assert result["macs"] * PIXELS / 1e9 == pytest.approx(compute, abs=0.005)
        assert result["weights"] / 1e3 == pytest.approx(weights, abs=0.05)
        assert result["storage"] * PIXELS / 1e6 == pytest.approx(storage, rel=0.003)
