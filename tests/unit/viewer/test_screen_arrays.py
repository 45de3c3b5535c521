"""The plan of a screen-space network, evaluated step by step, gives the network's visibility."""

import numpy as np
import pytest
import torch
from built_networks import make_screen_network
from network_page import smooth_planes, with_random_statistics
from torch.nn import functional
from viewer_page import unpacked

from neural_shadows.errors import InputError
from neural_shadows.networks.screen_space.pixel_kernels import filtered
from neural_shadows.viewer.screen_arrays import screen_arrays, with_half_weights

HEADER = {"rays": 2}
KERNELS = {
    "form": "kernels",
    "widths": [6, 8, 12],
    "filters": 2,
    "features": ["n", "log_d", "base_rays"],
}
TRIMMED = {"widths": [8, [6, 10], 12], "features": ["c_e", "ratio", "view"]}
NETWORKS = {
    "kernels": KERNELS,
    "kernels that keep to a surface": KERNELS | {"edge": 0.1},
    "direct": {"form": "direct", "widths": [6, 8, 12], "features": ["c_e", "n", "behind"]},
    "shuffle": TRIMMED | {"form": "shuffle"},
    "half": TRIMMED | {"form": "half"},
    "full": TRIMMED | {"form": "full"},
    "full, of reduced features": TRIMMED
    | {"form": "full", "extraction": 5, "first_skip": True, "pool": "max"},
}


def evaluated(data, planes):
    """Visibility (1, 1, H, W) by the plan of `data`, of planes (1, C, H, W)."""
    weights = unpacked(data["arrays"]["weights"]).view(np.float16).astype(np.float32)
    weights, at, maps = torch.from_numpy(weights), 0, []
    for step in data["plan"]:
        x, kind = maps[-1] if maps else planes, step["kind"]
        if kind == "entrance":
            centres, spreads = (
                torch.tensor(data[key])[:, None, None] for key in ("centres", "spreads")
            )
            x = (x - centres) / spreads
            x = {
                "SQUARES": lambda x: functional.pixel_unshuffle(x, 2),
                "MEANS": lambda x: functional.avg_pool2d(x, 2),
                "PIXELS": lambda x: x,
            }[step["mode"]](x)
        elif kind == "convolution":
            outputs, inputs = -(-step["channels"] // 4), -(-step["inputs"] // 4)
            count = outputs * inputs * (2 * step["size"] ** 2 + 1) * 8
            rows = weights[at : at + count].view(outputs, inputs, -1)
            at += count
            # In blocks (outputs, inputs, tap, input, output).
            blocks = rows[..., :-8].unflatten(2, (-1, 4, 4)).permute(0, 4, 1, 3, 2)
            weight = blocks.reshape(4 * outputs, 4 * inputs, step["size"], step["size"])
            bias = rows[:, 0, -8:-4].flatten()
            x = functional.pad(x, (0, 0, 0, 0, 0, -step["inputs"] % 4))
            if step["size"] == 2:
                x = functional.conv_transpose2d(x, weight.transpose(0, 1), bias, stride=2)
            else:
                border = [step["size"] // 2] * 4
                mode = {"ZERO": "constant", "REPLICATED": "replicate"}[step["border"]]
                x = functional.conv2d(functional.pad(x, border, mode=mode), weight, bias)
            x = (x.relu() if step["relu"] else x)[:, : step["channels"]]
        elif kind == "pool":
            pool = {"MAXIMUM": functional.max_pool2d, "MEAN": functional.avg_pool2d}[step["mode"]]
            x = pool(x, 2)
        elif kind == "enlargement":
            x = functional.interpolate(x, scale_factor=2, mode="bilinear")
        elif kind == "base":
            x = planes[:, data["base"], None]
        elif kind == "filter":
            taps = maps[step["logits"]][:, 4 * step["first"] :][:, :25]
            # Each filter is the last of as many, whose others leave its source as it is.
            number = step["dilation"].bit_length() - 1
            identity = torch.zeros_like(taps)
            identity[:, 12] = 1e4
            guide = None if data["guide"] is None else planes[:, data["guide"], None]
            limit = float("inf") if data["edge"] is None else data["edge"]
            x = filtered(torch.cat([identity] * number + [taps], 1), x, 2, guide, limit)
        elif kind == "exit" and step["mode"] == "SQUARES":
            detail = functional.pad(x, (0, 0, 0, 0, 0, 4 - x.shape[1]))
            detail[:, 0] = 0
            x = functional.interpolate(x[:, :1], scale_factor=2, mode="bilinear")
            x = x + functional.pixel_shuffle(detail, 2)
        maps.append(x + maps[step["skip"]] if "skip" in step else x)
        if "channels" in step:
            assert step["channels"] == x.shape[1]
            assert planes.shape[-1] == x.shape[-1] << step["level"]
    assert at == len(weights)
    return maps[-1]


@pytest.mark.parametrize("name", NETWORKS)
def test_plan_gives_the_networks_visibility(name):
    network = with_random_statistics(make_screen_network(NETWORKS[name]))
    data = screen_arrays(network, HEADER | {"network": NETWORKS[name]})
    planes = smooth_planes(data["planes"], 32, 48)[None]
    with torch.inference_mode():
        expected = with_half_weights(network)(planes)
        assert expected.std() > 0.05
        assert torch.allclose(evaluated(data, planes), expected, atol=1e-5)


def test_planes_are_those_of_the_training():
    settings = KERNELS | {"edge": 0.25}
    header = HEADER | {"network": settings}
    data = screen_arrays(make_screen_network(settings), header)
    assert data["features"] == ["n", "log_d", "base_rays"]
    assert (data["planes"], data["guide"], data["base"], data["edge"]) == (5, 3, 4, 0.25)
    assert data["rays"] == 2


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            {**TRIMMED, "form": "original", "widths": [4, 8]},
            "form: 'original'.* form: kernels or shuffle",
        ),
        ({**KERNELS, "ends": "full"}, "ends: 'full': .*ends: half"),
        (
            {**TRIMMED, "form": "half", "features": ["behind"], "answer": "exponent"},
            "answer: 'exponent': .*answer: visibility",
        ),
    ],
    ids=lambda value: value.get("form", "") if isinstance(value, dict) else "",
)
def test_network_without_shaders(settings, message):
    with pytest.raises(InputError, match=message):
        screen_arrays(make_screen_network(settings), HEADER | {"network": settings})


@pytest.mark.parametrize("value", [65_600.0, -1e6, float("nan")])
def test_weight_beyond_half_precision(value):
    network = make_screen_network(NETWORKS["kernels"])
    network.deepest[0].weight.data[0, 0, 0, 0] = value
    with pytest.raises(InputError, match=r"deepest\.0\.weight: .*half precision.*Train"):
        screen_arrays(network, HEADER | {"network": NETWORKS["kernels"]})


def test_a_network_keeps_its_own_weights():
    network = make_screen_network(NETWORKS["shuffle"])
    before = network.deepest[0].weight.clone()
    rounded = with_half_weights(network).deepest[0].weight
    assert torch.equal(network.deepest[0].weight, before) and not torch.equal(rounded, before)
    assert torch.equal(rounded, rounded.half().float())


def test_maps_beyond_half_precision_are_balanced():
    """The same answers, by maps within its range."""
    network = make_screen_network(NETWORKS["shuffle"]).requires_grad_(False)
    for level in network.levels[1:]:
        level.encoder[0].weight *= 3000
        level.decoder[-2].weight /= 3000
    planes = torch.rand(
        (1, len(network.centres), 64, 64), generator=torch.Generator().manual_seed(1)
    )
    rounded, largest = with_half_weights(network), []
    for layer in rounded.modules():
        if isinstance(layer, torch.nn.ReLU):
            layer.register_forward_hook(lambda _, __, output: largest.append(output.max()))
    whole = network(planes)
    assert (rounded(planes) - whole).abs().max() <= 0.01 * whole.abs().max()
    assert max(largest) < 100
