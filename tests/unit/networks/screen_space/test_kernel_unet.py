"""Kernel Predicting Neural Shadow Maps: counts, and known outputs."""

import pytest
import torch
from counted import counted
from torch.nn import functional
from unfolded import by_unfold

from neural_shadows.networks.screen_space.chunk_norm import chunk_statistics
from neural_shadows.networks.screen_space.kernel_unet import KernelUnet
from neural_shadows.networks.screen_space.kernel_widths import kernel_convolutions
from neural_shadows.networks.screen_space.widths import by_level, total

EIGHT = ["cosine", "c_v_by_d", "z_f", "penumbra", "behind", "z_b_by_z", "z_b", "base_msm"]
FOUR = ["c_e", "view", "difference", "ratio"]
WIDTHS = {3: [64, 128, 256], 4: [64, 64, 128, 256], 5: [64, 64, 128, 256, 512]}
SLIM = [32, 32, 64, 128]
TINY = [4, 4, 8]
# Parameters by layers and filters; multiply-adds a pixel with 4 filters at the frame's own size (spec
# 2.1): 6400 of the last convolution, of which a quarter is left at half the resolution.
PARAMETERS = {
    **{(3, 3): 1_648_011, (3, 4): 1_649_636, (3, 5): 1_651_261},
    **{(4, 3): 1_812_427, (4, 4): 1_814_052, (4, 5): 1_815_677},
    **{(5, 3): 7_058_635, (5, 4): 7_060_260, (5, 5): 7_061_885},
}
MACS = {3: 75_520, 4: 48_128, 5: 56_704}


def parameters(network):
    return sum(parameter.numel() for parameter in network.parameters())


# A form and its ends, by one word.
FORMS = {"kernels": ("kernels", "half"), "direct": ("direct", "half"), "full": ("kernels", "full")}
each_form = pytest.mark.parametrize("form", FORMS)


def tiny(name="kernels", seed=0):
    """A network whose norms have statistics and weights of their own."""
    form, ends = FORMS[name]
    features = FOUR if form == "direct" else EIGHT
    network = KernelUnet(form, TINY, features, filters=2, ends=ends)
    network.initialise(seed)
    generator = torch.Generator().manual_seed(1)
    for norm in network.norms():
        for parameter in (norm.weight.data, norm.running_var):
            parameter.copy_(0.5 + torch.rand(parameter.shape, generator=generator))
        for parameter in (norm.bias.data, norm.running_mean):
            parameter.copy_(torch.randn(parameter.shape, generator=generator) / 4)
    return network


def planes(network, *size):
    generator = torch.Generator().manual_seed(2)
    return torch.rand(1, len(network.features), *size, generator=generator)


def answer(network, x):
    with torch.inference_mode():
        return network(x)


@pytest.mark.parametrize(("layers", "filters"), PARAMETERS)
def test_parameters_are_those_of_the_table(layers, filters):
    assert (
        parameters(KernelUnet("kernels", WIDTHS[layers], EIGHT, filters))
        == PARAMETERS[layers, filters]
    )


def test_parameters_of_the_slim_and_the_direct_form():
    assert parameters(KernelUnet("kernels", SLIM, EIGHT)) == 456_516
    assert parameters(KernelUnet("direct", WIDTHS[4], FOUR)) == 1_815_809


@pytest.mark.parametrize("layers", WIDTHS)
def test_multiply_adds_are_those_of_the_table_with_the_head_at_half_resolution(layers):
    network = KernelUnet("kernels", WIDTHS[layers], EIGHT)
    expected = MACS[layers] - 6400 * 3 / 4
    assert counted(network, 8)[1] == expected
    assert total(kernel_convolutions("kernels", WIDTHS[layers], 8, 4), "macs") == expected


def test_the_head_before_the_enlargement_is_the_head_behind_it():
    """And what it leaves is filtered as `unfold` does it."""
    network, size = tiny(), (13, 21)
    x = planes(network, *size)
    with torch.inference_mode():
        large = functional.interpolate(network.inner(x), scale_factor=2, mode="bilinear")
        logits = network.head(large)[..., : size[0], : size[1]]
        expected = by_unfold(logits, x[:, -1:])
    assert torch.allclose(answer(network, x), expected, atol=1e-6)


def test_full_ends_have_a_level_more_and_kernels_of_each_pixel():
    """Two 3 × 3 convolutions on the way down, a transposed one and two on the way up, and the head."""
    widths = [32, 32, 64, 128, 256]
    layers = kernel_convolutions("kernels", widths, 8, 4, "full")
    network = KernelUnet("kernels", widths, EIGHT, ends="full")
    assert counted(network, 8) == (total(layers, "weights"), total(layers, "macs"))
    own = 9 * 8 * 32 + 3 * 9 * 32 * 32 + 4 * 32 * 32 + 32 * 100
    assert (
        by_level(layers, "weights")[0] == own and max(parameter.level for parameter in layers) == 4
    )
    network, size = tiny("full"), (13, 21)
    x = planes(network, *size)
    with torch.inference_mode():
        logits = network.head(network.inner(x))
        expected = by_unfold(logits[..., : size[0], : size[1]], x[:, -1:])
    assert torch.allclose(answer(network, x), expected, atol=1e-6)


@pytest.mark.parametrize("images", [1, 3])
def test_logits_lie_plane_by_plane_and_are_the_convolution_s(images):
    head = tiny().head
    x = torch.rand(images, 4, 6, 10).contiguous(memory_format=torch.channels_last)
    result = head(x)
    assert result.is_contiguous()
    assert torch.allclose(result, functional.conv2d(x, head.weight, head.bias), atol=1e-6)


@pytest.mark.parametrize("images", [1, 3])
def test_gradients_of_logits_are_exact_and_keep_the_memory_format(images):
    head = tiny().head.double()
    x = torch.rand(images, 4, 6, 10, dtype=torch.double)
    x = x.contiguous(memory_format=torch.channels_last).requires_grad_()
    (gradient,) = torch.autograd.grad(head(x).square().sum(), x)
    assert gradient.is_contiguous(memory_format=torch.channels_last)

    def logits(x, weight, bias):
        return torch.func.functional_call(head, {"weight": weight, "bias": bias}, x)

    assert torch.autograd.gradcheck(logits, (x, *head.parameters()), fast_mode=True)


@each_form
def test_folded_norms_give_the_same_output(form):
    network = tiny(form)
    x, folded = planes(network, 24, 16), network.for_inference()
    more = {"kernels": 0, "direct": 1, "full": 1}  # of the head, and of the first level's second
    assert not folded.norms() and len(network.norms()) == 9 + more[form]
    assert torch.allclose(answer(folded, x), answer(network, x), atol=1e-5)


@each_form
def test_norms_are_updated_in_order_of_computation(form):
    network, order = tiny(form), []
    before = [norm.running_mean.clone() for norm in network.norms()]
    for norm in network.norms():
        norm.register_forward_hook(lambda layer, *_: order.append(layer))
    chunks = []
    for _ in range(2):
        with chunk_statistics() as chunk:
            network(planes(network, 16, 16))
        chunks.append(chunk)
    assert order == 2 * network.norms()
    network.update_norms(chunks)
    for norm, old, parameter in zip(network.norms(), before, chunks[0], strict=True):
        assert torch.allclose(norm.running_mean, 0.9 * old + 0.1 * parameter.mean, atol=1e-6)


@each_form
def test_bfloat16_output_is_close(form):
    network = tiny(form)
    x = planes(network, 32, 32)
    exact = answer(network, x)
    for parameter in (network, network.for_inference()):
        off = (answer(parameter.in_format(torch.bfloat16), x) - exact).abs().mean()
        assert 0 < off < 0.1 * exact.std()


def test_index_of_the_base_after_three_channel_features():
    """Kernels of one base everywhere leave it as it is."""
    network = KernelUnet("kernels", TINY, ["n", "base_hard"])
    planes = torch.rand(1, 4, 16, 16)
    planes[:, 3] = 0.25
    assert torch.allclose(network(planes), torch.tensor(0.25))


def test_initial_kernels_are_near_the_identity():
    """Two of 25 weights each, the middle one of e⁴ against 1: 0.69² of it. A blur would leave 0.002."""
    network = KernelUnet("kernels", TINY, EIGHT, filters=2)
    x = planes(network, 32, 32)
    x[:, -1] = 0
    x[0, -1, 16, 16] = 1
    with chunk_statistics():
        result = answer(network, x)[0, 0]
    assert 0.3 < result[16, 16] < 0.6 and result.flatten().sort().values[-2] < 0.1


def test_kernels_without_a_base_are_refused():
    with pytest.raises(ValueError, match="filter one of the features base_hard, .*; there is none"):
        KernelUnet("kernels", TINY, FOUR)
    with pytest.raises(ValueError, match="there is base_msm and base_pcf"):
        KernelUnet("kernels", TINY, [*EIGHT, "base_pcf"])
