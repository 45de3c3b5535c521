"""Points and lights as tensors on a network's device."""

import numpy as np
import torch
from torch import Tensor


def on_device(points: np.ndarray, light: np.ndarray, device: torch.device) -> tuple[Tensor, Tensor]:
    """Points (m, 3) float32 and light (3,) as tensors on a device."""
    light = torch.from_numpy(np.asarray(light, np.float32))
    return torch.from_numpy(points).to(device), light.to(device)
