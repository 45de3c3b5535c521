"""Directions of Muon in both of its number formats."""

import pytest
import torch

from neural_shadows.training.optimisers import Muon, orthogonalised


@pytest.mark.parametrize("shape", [(32, 288), (128, 32)])
def test_directions_keep_singular_vectors_and_have_values_about_one(shape):
    gradient = torch.randn(shape, generator=torch.Generator().manual_seed(0))
    exact, rounded = (orthogonalised(gradient, dtype) for dtype in (torch.float32, torch.bfloat16))
    left, _, right = torch.linalg.svd(gradient, full_matrices=False)
    values = left.T @ exact @ right.T
    diagonal = values.diag()
    assert torch.allclose(values, diagonal.diag(), atol=1e-5)
    assert 0.5 < diagonal.min() < diagonal.max() < 1.3
    assert (rounded.float() - exact).norm() < 0.05 * exact.norm()


@pytest.mark.parametrize("shape", [(32, 16, 3, 3), (128, 32)])
def test_bfloat16_steps_are_those_of_torch_s_muon(shape):
    generator = torch.Generator().manual_seed(0)
    ours = torch.randn(shape, generator=generator)
    theirs = ours.clone().flatten(1)
    optimisers = (
        Muon({"weight": ours}, torch.bfloat16),
        torch.optim.Muon([theirs], weight_decay=0.0),
    )
    for rate in (0.02, 0.01, 0.005):
        ours.grad = torch.randn(shape, generator=generator)
        theirs.grad = ours.grad.flatten(1)
        optimisers[0].step(torch.tensor(rate))
        optimisers[1].param_groups[0]["lr"] = rate
        optimisers[1].step()
    torch.testing.assert_close(ours.flatten(1), theirs, rtol=1e-6, atol=1e-7)
