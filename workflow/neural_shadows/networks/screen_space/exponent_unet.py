"""Neural Shadow Mapping with a learned exponent (Datta et al. 2022, S6)."""

import math
from collections.abc import Sequence

import torch
from torch import Tensor

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space.shadow_unet import ShadowUnet
from neural_shadows.networks.settings.screen_space import BEHIND

DARKEST = 1 / 256  # lower bound in logarithms; not in the text


class ExponentUnet(ShadowUnet):
    """Visibility exp(−α b) from a learned α.

    b is the distance behind the light map's surface. An exponential shadow map (Annen et al. 2008)
    of learned sharpness. A training compares logarithms: 1 − α b / ln 256 with that of the target,
    from 0 at `DARKEST` to 1 where all is lit.

    Args:
        features: see `ShadowUnet`; with `behind`.
    """

    of_its_base = True

    def __init__(self, form: str, widths: Sequence, features: Sequence[str], **settings):
        super().__init__(form, widths, features, **settings)
        self._behind = channels_of(features[: features.index(BEHIND)])

    def loss_input(self, x: Tensor) -> Tensor:
        """Logarithms of visibility for the loss, (B, 1, H, W) float32."""
        return self._logarithms(super().loss_input(x), x)

    def _logarithms(self, sharpness: Tensor, x: Tensor) -> Tensor:
        return 1 - sharpness.float() * x[:, self._behind : self._behind + 1]

    def loss_target(self, target: Tensor) -> Tensor:
        """Target of `loss_input` from visibility (B, 1, H, W)."""
        return 1 - target.clamp(min=DARKEST).log() / math.log(DARKEST)

    def forward(self, x: Tensor) -> Tensor:
        """Visibility, not cut off at 1: (B, 1, H, W) float32 of features (B, C, H, W)."""
        return torch.exp((self.loss_input(x) - 1) * -math.log(DARKEST))

    def _in_bands(self, x: Tensor) -> Tensor:
        logarithms = self._logarithms(super()._in_bands(x), x)
        return torch.exp((logarithms - 1) * -math.log(DARKEST))
