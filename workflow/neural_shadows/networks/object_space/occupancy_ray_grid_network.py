"""Occupancy-clipped ray grid: sample points only near the surface.

They are spread between a ray's first and last cell touched by the surface. A ray without such a
cell is lit without any network.
"""

from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.object_space.ray_grid_network import RayGridNetwork
from neural_shadows.networks.object_space.shadow_network import chords
from neural_shadows.representations.packed_bits import pack_bits, unpack_bits
from neural_shadows.representations.voxels.occupancy import surface_cells


class OccupancyRayGridNetwork(RayGridNetwork):
    """t_pred(o, d) from features on the occupied part of rays.

    Args:
        occupancy: cells along an axis of the occupancy.
    """

    def __init__(self, *, occupancy: int, **settings: Any):
        super().__init__(**settings)
        self.occupancy = occupancy
        cells = torch.zeros(occupancy**3, dtype=torch.bool)
        self.register_buffer("cells", cells, persistent=False)

    def prepare(self, mesh_ply: Path) -> None:
        """Mark the cells touched by the surface."""
        mesh = read_prepared(mesh_ply)
        cells = surface_cells(mesh.vertices, mesh.faces, self.occupancy)
        self.cells = torch.from_numpy(cells.reshape(-1))

    def span(self, origins: Tensor, directions: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        chord = chords(origins, directions)
        n = self.occupancy
        # Two steps a cell: a corner cut between them loses half a cell of the span.
        steps = 2 * n
        t = (torch.arange(steps, device=chord.device) + 0.5) * (2 / steps)
        p = origins[:, None] + t[:, None] * directions[:, None]
        x, y, z = ((p + 1) * (n / 2)).long().clamp(0, n - 1).unbind(-1)
        occupied = self.cells[(x * n + y) * n + z] & (t < chord[:, None])
        first = torch.where(occupied, t, torch.inf).amin(1)
        last = torch.where(occupied, t, -torch.inf).amax(1)
        meets = last >= first
        half = 1 / steps
        t_a = torch.where(meets, (first - half).clamp(min=0), 0)
        return t_a, torch.where(meets, torch.minimum(last + half, chord), chord), meets

    def stored(self) -> dict[str, Tensor]:
        """Quantised weights, and a bit for each occupancy cell."""
        return super().stored() | {"cells": pack_bits(self.cells)}

    def restore(self, tensors: dict[str, Tensor]) -> None:
        tensors = dict(tensors)
        self.cells = unpack_bits(tensors.pop("cells"), len(self.cells))
        super().restore(tensors)
