"""What all forms of screen-space networks have in common."""

import pytest
import torch
from built_networks import layers_of, make_screen_network
from counted import counted
from torch.nn import functional

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space.chunk_norm import chunk_statistics
from neural_shadows.networks.screen_space.widths import by_level, total

FOUR = ["c_e", "view", "ratio", "difference"]
EIGHT = ["cosine", "c_v_by_d", "z_f", "penumbra", "behind", "z_b_by_z", "z_b", "base_msm"]
TRIMMED = {"widths": [8, 16], "features": FOUR}
KERNELS = {"form": "kernels", "widths": [4, 4, 8], "features": EIGHT, "filters": 2}
FULL = {"form": "full", "widths": [8, [16, 8], 32], "features": FOUR, "extraction": 6}
FIRST = "levels.0.encoder.0"
# Settings; multiples to which sides are padded; names of the first and the last convolution.
FORMS = {
    "full": (FULL | {"first_skip": True}, 4, ("extraction.0", "levels.0.decoder.4")),
    "shuffle": (TRIMMED | {"form": "shuffle"}, 4, (FIRST, "levels.0.decoder.2")),
    "half": (TRIMMED | {"form": "half"}, 4, (FIRST, "levels.0.decoder.2")),
    "original": (
        TRIMMED | {"form": "original", "widths": [8, 16, 32]},
        4,
        (FIRST, "levels.0.decoder.4"),
    ),
    "kernels": (KERNELS, 8, (FIRST, "head")),
    "full ends": (KERNELS | {"ends": "full"}, 4, (FIRST, "head")),
    "direct": ({"form": "direct", "widths": [4, 4, 8], "features": FOUR}, 8, (FIRST, "head.3")),
}
each_form = pytest.mark.parametrize(("settings", "multiple", "ends"), FORMS.values(), ids=FORMS)


def planes(settings, *size):
    generator = torch.Generator().manual_seed(2)
    return torch.rand(1, channels_of(settings["features"]), *size, generator=generator)


@each_form
@pytest.mark.parametrize("size", [(1, 1), (5, 7), (8, 16)])
def test_any_size_is_padded_by_its_border_and_cropped(settings, multiple, ends, size):
    network, x = make_screen_network(settings), planes(settings, *size)
    border = (0, -size[1] % multiple, 0, -size[0] % multiple)
    padded = functional.pad(x, border, mode="replicate")
    with torch.inference_mode():
        result = network(x)
        assert result.shape == (1, 1, *size) and result.dtype == torch.float32
        if settings["form"] == "kernels":  # which renormalise at the frame's own border
            assert torch.equal(network.inner(x), network.inner(padded))
        else:
            assert torch.equal(result, network(padded)[..., : size[0], : size[1]])


@each_form
def test_weights_depend_on_the_seed_alone(settings, multiple, ends):
    first = make_screen_network(settings)
    torch.manual_seed(2)
    second, other = make_screen_network(settings), make_screen_network(settings)
    other.initialise(3)
    assert all(map(torch.equal, first.state_dict().values(), second.state_dict().values()))
    assert not any(
        torch.equal(weight, third)
        for weight, third in zip(first.parameters(), other.parameters())
        if weight.ndim == 4
    )
    second.initialise(3)
    assert all(map(torch.equal, other.state_dict().values(), second.state_dict().values()))


@each_form
def test_modules_of_a_level_have_its_weights(settings, multiple, ends):
    network, layers = make_screen_network(settings), layers_of(settings)
    result = dict.fromkeys({level for level, _ in network.parts()}, 0)
    for (level, _), part in network.parts().items():
        result[level] += sum(weight.numel() for weight in part.parameters() if weight.ndim == 4)
    assert result == dict.fromkeys(result, 0) | by_level(layers, "weights")
    channels = channels_of(settings["features"])
    assert counted(network, channels) == (total(layers, "weights"), total(layers, "macs"))


@each_form
def test_every_weight_has_a_gradient_in_bfloat16(settings, multiple, ends):
    network = make_screen_network(settings).in_format(torch.bfloat16)
    x = planes(settings, 16, 16).contiguous(memory_format=torch.channels_last)
    with chunk_statistics():
        network(x).float().square().mean().backward()
    weights = [weight for weight in network.parameters() if weight.ndim == 4]
    assert all(weight.grad.abs().sum() > 0 for weight in weights)
    assert {norm.weight.dtype for norm in network.norms()} <= {torch.float32}


@each_form
def test_all_convolutions_but_the_first_and_the_last_are_hidden(settings, multiple, ends):
    network = make_screen_network(settings)
    weights = {name for name, weight in network.named_parameters() if weight.ndim == 4}
    assert weights - {*network.hidden()} == {f"{name}.weight" for name in ends}
