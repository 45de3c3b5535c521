"""The per-pixel kernel filter against `unfold` in float64."""

from concurrent.futures import ThreadPoolExecutor

import pytest
import torch
from torch.nn import functional
from unfolded import by_unfold

from neural_shadows.networks.screen_space.half_kernel_loops import HALF_BLOCK
from neural_shadows.networks.screen_space.pixel_kernel_loops import BLOCK
from neural_shadows.networks.screen_space.pixel_kernels import by_shifts, filtered

SIZES = {
    **{"one pixel": (1, 1), "smaller than a kernel": (3, 5), "odd": (37, 35)},
    **{"a block and a pixel": (6, BLOCK + 1), "blocks": (3, 2 * BLOCK + 20)},
    **{"a block of half the resolution and a pixel": (3, 2 * HALF_BLOCK + 1)},
}


def drawn(size, factor=1, levels=4, images=2, spread=3.0, dtype=torch.float32):
    """Logits, base and a gradient, of no more digits than the format of the logits."""
    generator = torch.Generator().manual_seed(sum(size))
    low = [-(-side // factor) for side in size]
    logits = spread * torch.randn(images, 25 * levels, *low, generator=generator)
    base, gradient = torch.rand(2, images, 1, *size, generator=generator)
    logits = logits.to(dtype).contiguous(memory_format=torch.channels_last)
    return logits.requires_grad_(), base.requires_grad_(), gradient


def values_and_gradients(work, logits, base, gradient, factor, dtype):
    inputs = [array.detach().to(dtype or array.dtype).requires_grad_() for array in (logits, base)]
    output = work(*inputs, factor)
    return [output.detach(), *torch.autograd.grad(output, inputs, gradient.to(output.dtype))]


@pytest.mark.parametrize("work", [filtered, by_shifts])
@pytest.mark.parametrize("factor", [1, 2])
@pytest.mark.parametrize("size", SIZES.values(), ids=SIZES)
def test_values_and_gradients_are_those_of_unfold(work, factor, size):
    inputs_of = drawn(size, factor)
    ours = values_and_gradients(work, *inputs_of, factor, None)
    theirs = values_and_gradients(by_unfold, *inputs_of, factor, torch.float64)
    for array, other in zip(ours, theirs, strict=True):
        assert array.dtype == torch.float32
        assert torch.allclose(array.double(), other, rtol=0, atol=3e-6)


@pytest.mark.parametrize("dtype", [torch.float32, torch.bfloat16])
def test_rows_of_large_logits_among_others(dtype):
    """Beyond ±40 the largest is subtracted: exp(100) is no float32."""
    logits, base, _ = drawn((40, 37), 2, dtype=dtype)
    logits.detach()[:, :, 7:12].mul_(60).clamp_(-90, 90)
    ours = filtered(logits, base, 2)
    theirs = by_unfold(logits.double(), base.double(), 2)
    assert torch.allclose(ours.double(), theirs, rtol=0, atol=2e-5)  # of 90: steps of 7.6e-6


@pytest.mark.parametrize("work", [filtered, by_shifts])
@pytest.mark.parametrize("factor", [1, 2])
def test_bfloat16_is_read_to_its_last_digit(work, factor):
    inputs_of = drawn((18, 130), factor, dtype=torch.bfloat16)
    value, of_logits, of_base = values_and_gradients(work, *inputs_of, factor, None)
    theirs = values_and_gradients(by_unfold, *inputs_of, factor, torch.float64)
    assert value.dtype == of_base.dtype == torch.float32 and of_logits.dtype == torch.bfloat16
    assert torch.allclose(value.double(), theirs[0], rtol=0, atol=3e-6)
    assert torch.allclose(of_base.double(), theirs[2], rtol=0, atol=3e-6)
    assert torch.allclose(of_logits.double(), theirs[1], rtol=2**-8, atol=1e-6)


@pytest.mark.parametrize("work", [filtered, by_shifts])
@pytest.mark.parametrize("factor", [1, 2])
def test_no_tap_across_a_step_of_the_guide(work, factor):
    """Both sides of a step are filtered as frames of their own; values and gradients."""
    logits, base, gradient = drawn((24, 40), factor)
    guide = torch.zeros_like(base.detach())
    guide[..., 20:] = 1.0
    output = work(logits, base, factor, guide, 0.5)
    changes = torch.autograd.grad(output, [logits, base], gradient)
    # Enlarged first: bilinear interpolation of logits does cross the step.
    full = logits.detach().contiguous()
    if factor > 1:
        full = functional.interpolate(full, scale_factor=2, mode="bilinear")
    for side in (slice(0, 20), slice(20, 40)):
        own = base.detach()[..., side].contiguous().requires_grad_()
        alone = work(full[..., side].contiguous(), own)
        assert torch.allclose(output[..., side], alone, rtol=0, atol=3e-6)
        (of_base,) = torch.autograd.grad(alone, [own], gradient[..., side].contiguous())
        assert torch.allclose(changes[1][..., side], of_base, rtol=0, atol=3e-6)
    unlimited = work(logits, base, factor)
    assert not torch.allclose(output, unlimited, atol=1e-3)
    none_beyond = work(logits, base, factor, guide, 2.0)
    assert torch.allclose(none_beyond, unlimited, rtol=0, atol=1e-6)


@pytest.mark.parametrize("size", [(7, 1025), (2, 4 * HALF_BLOCK + 3)])
def test_a_guide_in_rows_of_small_logits_and_of_others(size):
    """A logit of −60 in each kernel's last tap changes the way, and no weight; some steps are the limit."""
    logits, base, _ = drawn(size, 2)
    guide = torch.randint(9, base.shape, generator=torch.Generator().manual_seed(1)) / 8
    logits = logits.detach().clamp(-10)
    logits[:, 24::25] = -39
    small = filtered(logits, base, 2, guide, 0.25)
    logits[:, 24::25] = -60
    others = filtered(logits, base, 2, guide, 0.25)
    assert torch.allclose(small, others, rtol=0, atol=1e-6)
    assert not torch.equal(small, others)  # each way rounds on its own
    assert not torch.allclose(small, filtered(logits, base, 2), atol=1e-3)


@pytest.mark.parametrize(("levels", "reach"), [(3, 14), (4, 30), (5, 62)])
def test_a_pixel_is_within_what_its_kernels_reach(levels, reach):
    """The smallest and the largest of 29, 61, 125 pixels along and down; and no fewer count."""
    logits, base, _ = drawn((130, 132), levels=levels, images=1)
    base = base.detach() * (base.detach() > 0.998)
    output = filtered(logits, base).detach()
    largest = functional.max_pool2d(base, 2 * reach + 1, 1, reach)
    smallest = -functional.max_pool2d(-base, 2 * reach + 1, 1, reach)
    assert bool((output <= largest * (1 + 1e-6)).all())
    assert bool((output >= smallest * (1 - 1e-6)).all())
    assert bool((largest == 0).any() or levels > 3)
    impulse = torch.zeros_like(base)
    impulse[0, 0, 65, 66] = 1
    reached = filtered(torch.zeros_like(logits), impulse)[0, 0] > 0
    assert reached.any(0).sum() == reached.any(1).sum() == min(2 * reach + 1, 130)


def test_a_constant_picture_stays_constant():
    logits, base, _ = drawn((33, 140), spread=30.0)
    output = filtered(logits, torch.full_like(base, 0.3))
    assert torch.allclose(output, torch.tensor(0.3), rtol=1e-6, atol=0)


def test_weights_outside_the_frame_are_ignored():
    """Softmax first would leave 0 / 0 in float32."""
    logits, base = torch.zeros(1, 25, 1, 4), torch.tensor([[[[1.0, 2.0, 3.0, 4.0]]]])
    logits[:, 2] = 200  # the row above
    output = filtered(logits, base)
    assert torch.allclose(output[0, 0, 0], torch.tensor([2.0, 2.5, 2.5, 3.0]))


@pytest.mark.parametrize("broken", [torch.nan, torch.inf])
@pytest.mark.parametrize("factor", [1, 2])
def test_nan_logits_give_nan(broken, factor):
    """A training looks for it in the loss."""
    logits, base = torch.zeros(1, 25, 4, 4), torch.rand(1, 1, 4 * factor, 4 * factor)
    logits[0, 12, 1, 2] = broken
    is_nan = filtered(logits, base, factor)[0, 0].isnan()
    expected = torch.zeros_like(is_nan)  # enlarged bilinearly, a logit reaches 4 × 4 pixels
    expected[(slice(1, 5), slice(3, 7)) if factor == 2 else (1, 2)] = True
    assert torch.equal(is_nan, expected)


@pytest.mark.parametrize(
    ("logits", "base", "factor"),
    [((1, 25, 4, 4), (1, 1, 4, 5), 1), ((1, 25, 4, 4), (1, 1, 9, 8), 2)]
    + [((2, 25, 4, 4), (1, 1, 4, 4), 1), ((1, 24, 4, 4), (1, 1, 4, 4), 1)],
)
def test_a_base_of_another_size_is_refused(logits, base, factor):
    with pytest.raises(ValueError, match="do not fit a base of"):
        filtered(torch.zeros(logits), torch.zeros(base), factor)


def test_a_tap_is_moved_by_its_level_s_dilation():
    logits, base, _ = drawn((30, 40), levels=3, images=1)
    chosen = torch.full_like(logits, -100.0)
    for level, tap in enumerate((3, 10, 12)):  # right and up; left by two; the middle
        chosen[:, 25 * level + tap] = 100
    output = filtered(chosen, base)[0, 0, 10:20, 10:20]
    # Level 0 goes two up and one right, level 1 four left.
    assert torch.allclose(output, base[0, 0, 8:18, 7:17])


def test_threads_do_not_change_results():
    inputs_of = drawn((40, 64), factor=2, images=1)
    expected = values_and_gradients(filtered, *inputs_of, 2, None)
    with ThreadPoolExecutor(3) as pool:
        side_by_side = [
            pool.submit(values_and_gradients, filtered, *inputs_of, 2, None) for _ in range(6)
        ]
        assert all(map(torch.equal, array.result(), expected) for array in side_by_side)
    threads = torch.get_num_threads()
    try:
        torch.set_num_threads(3)
        assert torch.equal(filtered(inputs_of[0], inputs_of[1], 2).detach(), expected[0])
    finally:
        torch.set_num_threads(threads)
