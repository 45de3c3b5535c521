"""Voxel DAG: a ray ends in the object's first voxel.

Nothing is trained. The closest relatives of trained fields: Kämpe et al. 2013, "High resolution
sparse voxel DAGs", and Sintorn et al. 2014, "Compact precomputed voxelized shadows", whose voxels
are the shadow of one light; here they are the object's, for all lights.
"""

from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.untrained.untrained_network import UntrainedNetwork
from neural_shadows.representations.voxels.voxel_bricks import surface_bricks
from neural_shadows.representations.voxels.voxel_dag import (
    check_offsets,
    first_voxels,
    merged,
    octree,
    words_of,
)
from neural_shadows.representations.voxels.voxel_inside import inside_of


class VoxelDagNetwork(UntrainedNetwork):
    """t_pred(o, d) at a ray's first voxel.

    Args:
        resolution: voxels along an axis of [−1, 1]³, a power of two from 8 to 4096.
        surface: `solid`, the voxels enclosed but not touched by the surface; or `sheet`, the
            touched ones. The latter stand out from the object by up to a voxel, so that it shadows
            itself: on the Stanford dragon at 512³, 27.7 dB with the best depth bias, the former
            32.4 dB with none. To a ray from outside both together equal the latter. The former lies within
            the object, so that all its error is light leak: touched voxels that are mostly inside are left out, too.
    """

    def __init__(self, *, resolution: int, surface: str):
        super().__init__()
        self.levels = resolution.bit_length() - 1
        self.surface = surface
        self.words = np.zeros(1, np.uint32)

    def prepare(self, mesh_ply: Path) -> None:
        """Build the DAG of the mesh's voxels."""
        mesh = read_prepared(mesh_ply)
        tree = octree(surface_bricks(mesh.vertices, mesh.faces, self.levels), self.levels)
        if self.surface == "solid":
            tree = inside_of(tree)
        self.words = words_of(merged(tree))

    def forward(self, origins: Tensor, directions: Tensor, dtype: torch.dtype) -> Tensor:
        """See `ShadowNetwork.forward`; `LIT` for misses."""
        rays = origins.contiguous().numpy(), directions.contiguous().numpy()
        return torch.from_numpy(first_voxels(*rays, self.words, self.levels))

    def resident_bytes(self) -> int:
        """See `ShadowNetwork.resident_bytes`: the file's words."""
        return self.words.nbytes

    def stored(self) -> dict[str, Tensor]:
        """See `ShadowNetwork.stored`; a 32-bit word a node and a child."""
        return {"words": torch.from_numpy(self.words.view(np.int32))}

    def restore(self, tensors: dict[str, Tensor]) -> None:
        """See `ShadowNetwork.restore`."""
        words = tensors["words"].numpy()
        if words.dtype != np.int32 or words.ndim != 1:
            raise ValueError(f"{words.shape} {words.dtype} words")
        check_offsets(words.view(np.uint32), self.levels)
        self.words = words.view(np.uint32)
