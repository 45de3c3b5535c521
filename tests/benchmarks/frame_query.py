"""A frame's shadow mask from its depth buffer, all on one device, as a renderer would ask for it."""

import numpy as np
import torch
from torch import Tensor

from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import network_lit
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.cameras import camera_axes


class FrameQuery:
    """A depth buffer on a device, and the camera and the light that it belongs to.

    It holds, for each pixel, the distance along the view axis of what the pixel shows; zero where
    that is nothing that faces the light, which needs no query. What it shows was moved off its
    surface before, so that the buffer needs no normals beside it.
    """

    def __init__(self, frame: GBuffer, device: torch.device):
        def there(values: np.ndarray) -> Tensor:
            return torch.from_numpy(np.asarray(values, np.float32)).to(device)

        view = frame.view
        self.width, self.height = frame.width, frame.height
        self.eye, self.light = there(view.eye), there(view.light)
        self.axes = there(camera_axes(view.eye, view.target, view.up))
        half = np.tan(np.radians(view.fov) / 2)
        self.half_width, self.half_height = float(half * self.width / self.height), float(half)
        pixel = torch.from_numpy(frame.pixel[frame.lit_side]).to(device)
        self.depth = torch.zeros(self.height * self.width, device=device)
        self.depth[pixel] = (there(frame.p) - self.eye) @ self.axes[2]

    def points(self) -> tuple[Tensor, Tensor]:
        """The pixels that show something, (m,) int64, and what they show, (m, 3) float32."""
        pixel = self.depth.nonzero().squeeze(1)
        x = (2 * (pixel % self.width + 0.5) / self.width - 1) * self.half_width
        y = (1 - 2 * (pixel // self.width + 0.5) / self.height) * self.half_height
        rays = torch.stack([x, y, torch.ones_like(x)], dim=1) @ self.axes
        return pixel, self.eye + self.depth[pixel, None] * rays

    def mask(self, network: ShadowNetwork, dtype: torch.dtype) -> Tensor:
        """Which pixels show lit points, (height, width) bool."""
        pixel, p = self.points()
        lit = torch.zeros(self.height * self.width, dtype=torch.bool, device=p.device)
        lit[pixel] = network_lit(network, p, self.light, dtype=dtype)
        return lit.view(self.height, self.width)
