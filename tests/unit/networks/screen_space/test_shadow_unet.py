"""Neural Shadow Mapping's networks: known outputs."""

import math

import pytest
import torch
from built_networks import make_screen_network
from torch.nn import functional

from neural_shadows.networks.screen_space.layers import SquareOfPixels

FOUR = ["c_e", "view", "ratio", "difference"]
FORMS = {
    "full": {"form": "full", "widths": [8, [16, 8], 32]},
    "shuffle": {"form": "shuffle", "widths": [8, 16]},
    "half": {"form": "half", "widths": [8, 16]},
    "original": {"form": "original", "widths": [8, 16, 32]},
}


def build(form="full", **more):
    return make_screen_network({**FORMS[form], "features": FOUR, **more})


def answer(network, x):
    with torch.inference_mode():
        return network(x)


@pytest.mark.parametrize("form", ["full", "shuffle", "half"])
def test_a_constant_frame_has_a_constant_output(form):
    """Convolutions that pad with zeros see an edge there; shuffled pixels differ within squares."""
    result = answer(build(form), torch.full((1, 4, 24, 24), 0.7))
    squares = result.unfold(2, 2, 2).unfold(3, 2, 2)[0, 0]
    assert torch.allclose(squares, squares[:1, :1].expand_as(squares), atol=1e-5)


@pytest.mark.parametrize("form", FORMS)
def test_the_output_starts_about_a_half(form):
    network = build(form)
    for name, parameter in network.named_parameters():
        if name.endswith("weight"):
            torch.nn.init.zeros_(parameter)
    assert torch.equal(answer(network, torch.rand(1, 4, 8, 8)), torch.full((1, 1, 8, 8), 0.5))


def test_four_channels_are_the_pixels_of_a_square():
    o = torch.zeros(1, 4, 3, 3)
    o[0, 0] = torch.rand(3, 3)
    smooth = functional.interpolate(o[:, :1], scale_factor=2, mode="bilinear", align_corners=False)
    assert torch.equal(SquareOfPixels()(o), smooth)
    for channel, (down, right) in {1: (0, 1), 2: (1, 0), 3: (1, 1)}.items():
        impulse = torch.zeros(1, 4, 3, 3)
        impulse[0, channel, 1, 2] = 1
        expected = torch.zeros(1, 1, 6, 6)
        expected[0, 0, 2 + down, 4 + right] = 1
        assert torch.equal(SquareOfPixels()(impulse), expected)


def test_first_skip_and_pool():
    """A network that hands on level 0 alone sees it by its skip only."""
    x = torch.rand(1, 4, 8, 8)
    for first_skip in (False, True):
        network = build(first_skip=first_skip)
        torch.nn.init.zeros_(network.levels[1].decoder[2].weight)
        varies = bool(answer(network, x).std() > 1e-6)
        assert varies == first_skip
    average, largest = build(pool="average"), build(pool="max")
    assert not torch.allclose(answer(average, x), answer(largest, x))


def test_a_network_in_another_format_scales_channels_as_before():
    network = build()
    network.centres[:], network.spreads[:] = 1.003, 0.01
    x = 1 + 0.01 * torch.rand(1, 4, 16, 16)
    result = answer(network.in_format(torch.bfloat16), x).float()
    off = (result - answer(network, x)).abs().mean()
    assert off < 0.1 * answer(network, x).std()


def test_features_of_three_channels_count_as_three():
    network = build(features=["ratio", "n"])
    assert network.features == ("ratio", "n")
    assert answer(network, torch.zeros(1, 4, 4, 4)).shape == (1, 1, 4, 4)


def test_an_exponent_s_visibility_falls_with_the_distance_behind():
    """Of one α everywhere: exp(−α b), and what it is trained by is linear in b."""
    network = build("shuffle", features=[*FOUR, "behind"], answer="exponent")
    with torch.no_grad():
        for parameter in network.parameters():
            parameter.zero_()
        network.levels[0].decoder[-1].bias[0] = 3.0
    x = torch.rand(1, 5, 8, 12)
    x[:, 4, 0] = 0  # nothing hides the light
    alpha = 3.0 * math.log(256)
    result = answer(network, x)
    assert torch.allclose(result, torch.exp(-alpha * x[:, 4:]), rtol=1e-4)
    assert (result[..., 0, :] == 1).all()
    compared = 1 - alpha * x[:, 4:] / math.log(256)
    assert torch.allclose(network.loss_input(x), compared, atol=1e-5)
    reached = torch.tensor([1.0, 1 / 16, 1 / 256, 0.0]).view(1, 1, 1, 4)
    assert network.loss_target(reached).flatten().tolist() == pytest.approx(
        [1, 0.5, 0, 0], abs=1e-6
    )


def test_an_exponent_needs_the_distance_behind():
    with pytest.raises(ValueError, match="c_e, view.*no 'behind'"):
        build("shuffle", answer="exponent")
