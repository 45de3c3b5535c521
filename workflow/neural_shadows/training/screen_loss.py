"""The loss of a screen-space network [Datta et al. 2022, 3.3]."""

from typing import NamedTuple

import torch
from torch import Tensor

from neural_shadows.training.perceptual import Perceptual


class Terms(NamedTuple):
    """Of an output against another picture: L1, and the perceptual distance (0 without one)."""

    l1: Tensor
    perceptual: Tensor


class ScreenLoss:
    """L(a, b) = α |a − b| + (1 − α) factor · perceptual(a, b), means over valid pixels.

    A step's loss is L(output, target), and if a twin is given + p · L(output, twin's output), where
    the twin's output carries no gradient. With p times one twin drawn of p, the expectation is the
    paper's sum over all p.

    Args:
        alpha: α. perturbation: p. perceptual: None for L1 alone, whose weight is α then, too.
    """

    def __init__(self, alpha: float, perturbation: float, perceptual: Perceptual | None):
        self._alpha, self._perturbation = alpha, perturbation
        self._perceptual = perceptual
        self.factor = 0.0  # of the perceptual distance, see `factor_for`

    def factor_for(self, terms: Terms) -> float:
        """The factor with which the perceptual term is half of the L1 term."""
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
        """The share of some pictures in a step's loss.

        Args:
            output, target, twin: (B, 1, H, W) float32; valid, twin_valid: likewise, bool.
            count: valid pixels of the whole step.
        """
        others = [(target, valid)]
        if twin is not None:
            others.append((twin.detach(), valid & twin_valid))
        first, *rest = self.terms(output, valid, others, count)
        loss = self._whole(first)
        for terms in rest:
            loss = loss + self._perturbation * self._whole(terms)
        return loss

    def terms(
        self, output: Tensor, valid: Tensor, others: list[tuple[Tensor, Tensor]], count: int
    ) -> list[Terms]:
        """The output against other pictures, each with the pixels that count.

        What does not count is the same in both, and without gradient.
        """
        still = output.detach()
        shown = torch.where(valid, output, still)
        pictures = [torch.where(counts, other, still) for other, counts in others]
        l1 = [(shown - picture).abs().sum() / count for picture in pictures]
        if self._perceptual is None:
            return [Terms(one, torch.zeros_like(one)) for one in l1]
        seen = self._perceptual.features(shown)
        with torch.no_grad():
            theirs = [self._perceptual.features(picture) for picture in pictures]
        share = output[:, 0].numel() / count
        distance = self._perceptual.distance
        return [Terms(one, share * distance(seen, its)) for one, its in zip(l1, theirs)]

    def _whole(self, terms: Terms) -> Tensor:
        return self._alpha * terms.l1 + (1 - self._alpha) * self.factor * terms.perceptual
