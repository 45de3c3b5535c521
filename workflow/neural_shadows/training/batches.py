"""Training batches of rays, from disk or GPU memory."""

import numpy as np
import torch
from torch import Tensor

from neural_shadows.networks.object_space.shadow_network import LabelledBatch
from neural_shadows.rays.ray_set import RaySet

# SplitMix64 (Steele, Lea and Flood 2014), in signed numbers, which wrap likewise.
GAMMA = 0x9E3779B97F4A7C15 - 2**64
_MIX = ((30, 0xBF58476D1CE4E5B9 - 2**64), (27, 0x94D049BB133111EB - 2**64), (31, 1))


class HostRays:
    """Rays on disk or in its cache; batches are copied."""

    def __init__(self, rays: RaySet, device: torch.device):
        self._rays, self._device = rays, device

    def gather(self, indices: Tensor) -> LabelledBatch:
        """Rays of indices (n,) int64, on the device."""
        parts = self._rays.gather(indices.cpu().numpy())
        return LabelledBatch(*(torch.from_numpy(part).to(self._device) for part in parts))


class DeviceRays:
    """A ray set in device memory: 20 bytes a ray, 5 GB for the thesis's 250 million."""

    def __init__(self, rays: RaySet, device: torch.device):
        self._points = rays.points_per_direction
        self._directions = torch.from_numpy(rays.directions).to(device)
        # Copied because torch takes no read-only arrays.
        self._origins, self._bounds = (
            torch.cat(
                [torch.from_numpy(np.array(shard)).to(device).flatten(0, 1) for shard in part]
            )
            for part in (rays.origins, rays.bounds)
        )

    def gather(self, indices: Tensor) -> LabelledBatch:
        """Rays of indices (n,) int64 on the device."""
        directions = torch.div(indices, self._points, rounding_mode="floor")
        bounds = self._bounds.index_select(0, indices)
        return LabelledBatch(
            self._origins.index_select(0, indices),
            self._directions.index_select(0, directions),
            bounds[:, 0],
            bounds[:, 1],
        )


def batch_source(rays: RaySet, device: torch.device) -> HostRays | DeviceRays:
    """Put rays on a GPU with enough memory: twice theirs must be free."""
    if device.type == "cuda":
        free, _ = torch.cuda.mem_get_info(device)
        if 20 * rays.count < free / 2:
            return DeviceRays(rays, device)
    return HostRays(rays, device)


def batch_indices(step: Tensor, *, seed: int, batch_size: int, count: int) -> Tensor:
    """Draw indices of a step's samples with replacement: (batch_size,) int64.

    Determined by (seed, step): a resumed run needs no generator state, and GPU and CPU draw the
    same.

    Args:
        step: int64 without dimensions, on the device of the indices.
        count: of all rays.
    """
    start = int(np.random.SeedSequence(seed).generate_state(1, np.uint64)[0].astype(np.int64))
    x = step * batch_size + torch.arange(1, batch_size + 1, device=step.device)
    return _shifted(split_mix(start + GAMMA * x), 1) % count


def split_mix(state: Tensor) -> Tensor:
    """Outputs of SplitMix64 at states `GAMMA` apart, all int64."""
    for shift, factor in _MIX:
        state = (state ^ _shifted(state, shift)) * factor
    return state


def _shifted(x: Tensor, bits: int) -> Tensor:
    """Logical shift to the right."""
    return (x >> bits) & ((1 << (64 - bits)) - 1)
