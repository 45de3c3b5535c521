"""Loss of a screen-space network [Datta et al. 2022, 3.3]."""

from typing import NamedTuple

import torch
from torch import Tensor

from neural_shadows.training.perceptual import Perceptual


class Terms(NamedTuple):
    """L1 and perceptual distance (0 without one) of two pictures."""

    l1: Tensor
    perceptual: Tensor


class ScreenLoss:
    """Loss against the target and a perturbed frame's output.

    L(a, b) = α |a − b| + (1 − α) factor · perceptual(a, b), means over valid pixels. A step's loss
    is L(output, target), with a perturbed frame (`twin`) + p · L(output, its output), without
    gradient for its output. With p times one of p perturbed frames, the expectation is the paper's
    sum over all p.

    Args:
        alpha: α. perturbation: p. perceptual: None for L1 alone, still weighted by α.
    """

    def __init__(self, alpha: float, perturbation: float, perceptual: Perceptual | None):
        self._alpha, self._perturbation = alpha, perturbation
        self._perceptual = perceptual
        self.factor = 0.0  # of the perceptual distance, see `factor_for`

    def factor_for(self, terms: Terms) -> float:
        """Factor for a perceptual term of half the L1 term."""
        l1, perceptual = (float(term) for term in terms)
        if self._alpha == 1 or perceptual == 0:
            return 0.0
        return self._alpha * l1 / (2 * (1 - self._alpha) * perceptual)

    def __call__(
        self,
        output: Tensor,
        target: Tensor,
        valid: Tensor,
        count: int,
        twin: Tensor | None = None,
        twin_valid: Tensor | None = None,
    ) -> Tensor:
        """Share of some pictures in a step's loss.

        Args:
            output, target, twin: (B, 1, H, W) float32; valid, twin_valid: likewise, bool.
            count: valid pixels of the whole step.
        """
        others = [(target, valid)]
        if twin is not None:
            others.append((twin.detach(), valid & twin_valid))
        first, *rest = self.terms(output, valid, others, count)
        loss = self._weighted(first)
        for terms in rest:
            loss = loss + self._perturbation * self._weighted(terms)
        return loss

    def terms(
        self, output: Tensor, valid: Tensor, others: list[tuple[Tensor, Tensor]], count: int
    ) -> list[Terms]:
        """Compare the output with other pictures, each with valid pixels.

        Invalid pixels are equal in both, and without gradient.
        """
        constant = output.detach()
        masked = torch.where(valid, output, constant)
        pictures = [torch.where(valid_pixels, other, constant) for other, valid_pixels in others]
        l1 = [(masked - picture).abs().sum() / count for picture in pictures]
        if self._perceptual is None:
            return [Terms(term, torch.zeros_like(term)) for term in l1]
        features = self._perceptual.features(masked)
        with torch.no_grad():
            picture_features = [self._perceptual.features(picture) for picture in pictures]
        share = output[:, 0].numel() / count
        distance = self._perceptual.distance
        return [
            Terms(term, share * distance(features, other_features))
            for term, other_features in zip(l1, picture_features)
        ]

    def _weighted(self, terms: Terms) -> Tensor:
        return self._alpha * terms.l1 + (1 - self._alpha) * self.factor * terms.perceptual
