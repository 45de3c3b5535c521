"""The thesis's shadow network, from rays to shadow depths [3.3]."""

import math

import torch
from torch import Tensor, nn

from neural_shadows.networks.object_space.shadow_network import ShadowNetwork


class FrequencyEncoding(nn.Module):
    """γ(x) = (x, sin 2⁰πx, cos 2⁰πx, …, sin 2^(L−1)πx, cos 2^(L−1)πx) of six scalars [3.3.2].

    Args:
        frequencies: L ≥ 0; L = 0 is the identity encoding.
    """

    def __init__(self, frequencies: int):
        super().__init__()
        self.size = 6 * (1 + 2 * frequencies)
        scale = math.pi * 2.0 ** torch.arange(frequencies, dtype=torch.float32)
        self.register_buffer("scale", scale, persistent=False)

    def forward(self, x: Tensor) -> Tensor:
        """Encode (n, 6) float32 in [0, 1] as (n, 6(1 + 2L)): x, sines, cosines."""
        # Always float32: bfloat16's 8 bits cannot hold the phase 2⁹πx.
        phase = (x[:, :, None] * self.scale).flatten(1)
        return torch.cat([x, phase.sin(), phase.cos()], dim=1)


class FrequencyNetwork(ShadowNetwork):
    """t_pred(o, d) by a multilayer perceptron without biases.

    The encoding, a layer into `width`, hidden layers, one output. ReLU follows every layer, the
    last too [4.1]. The output is t/2, in [0, 1] inside the unit sphere; `forward` returns t.

    Args:
        frequencies: L of the frequency encoding.
        width: neurons per layer.
        hidden_layers: number of width × width layers.
    """

    recordable = True

    def __init__(self, *, frequencies: int, width: int, hidden_layers: int):
        super().__init__()
        self.encoding = FrequencyEncoding(frequencies)
        sizes = [self.encoding.size] + [width] * (hidden_layers + 1)
        self.layers = nn.ParameterList(
            nn.Parameter(torch.empty(out, into)) for into, out in zip(sizes, sizes[1:])
        )
        self.output = nn.Parameter(torch.empty(1, width))

    def initialise(self, seed: int) -> None:
        """He initialisation with an output layer alive from the start.

        Activations after a ReLU are never negative, so an output layer without negative
        weights makes every first prediction positive, whatever the seed. Over 64 seeds and
        all the thesis's widths the mean t/2 was 0.17 to 0.95, and 0.47 on average.
        """
        generator = torch.Generator().manual_seed(seed)
        with torch.no_grad():
            for weight in self.layers:
                nn.init.kaiming_uniform_(weight, nonlinearity="relu", generator=generator)
            # The encoding's mean square is 1/2 and He layers keep it, so that a rectified
            # Gaussian activation has mean √(1/2) / √π ≈ 0.4; U(0, 2s) has mean s.
            mean_activation = math.sqrt(0.5 / math.pi)
            self.output.uniform_(
                0, 1 / (self.output.numel() * mean_activation), generator=generator
            )

    def forward(self, origins: Tensor, directions: Tensor, dtype: torch.dtype) -> Tensor:
        x = (torch.cat([origins, directions], dim=1) + 1) / 2
        h = self.encoding(x).to(dtype)
        for weight in self.layers:
            h = nn.functional.linear(h, weight.to(dtype)).relu_()
        # The last product in float32: a depth rounded to bfloat16 would be off by up to 1/256.
        return 2 * nn.functional.linear(h.float(), self.output).relu_().squeeze(1)
