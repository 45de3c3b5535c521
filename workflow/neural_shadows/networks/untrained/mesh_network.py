"""The mesh itself, decimated and quantised: one occlusion ray a point."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from neural_shadows.meshes.cleaning import clean_mesh
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.object_space.sphere_rays import SphereRays
from neural_shadows.networks.untrained.untrained_network import UntrainedNetwork
from neural_shadows.representations.depths import LIT
from neural_shadows.representations.meshes.coded_mesh import coded, decoded
from neural_shadows.representations.meshes.decimation import decimated
from neural_shadows.representations.packed_bits import pack_integers, unpack_integers
from neural_shadows.scenes.tracing import Tracer

# Memory of Embree 4: its own copy of the mesh, 16 bytes a vertex and 12 a triangle, and its tree.
# The tree is measured: resident bytes before and after building, after malloc_trim, less the copy.
# For the Stanford dragon with 9,203, 20,139, 86,698 and 201,031 triangles it took 72, 71, 69 and 69
# bytes a triangle.
VERTEX_BYTES, FACE_BYTES, TREE_BYTES = 16, 12, 70


class MeshNetwork(UntrainedNetwork):
    """t_pred(o, d) at a ray's first hit of a mesh.

    Args:
        triangles: number after decimation; None for all.
        bits: of each coordinate of a vertex, in [−1, 1].
        stored: `packed` bits, or `coded`, see `coded_mesh`.
    """

    query_chunks = {"cpu": 1 << 16}

    def __init__(self, *, triangles: int | None, bits: int, stored: str = "packed"):
        super().__init__()
        self.triangles, self.bits, self.storage = triangles, bits, stored

    def prepare(self, mesh_ply: Path) -> None:
        """Decimate and quantise the mesh."""
        mesh = read_prepared(mesh_ply)
        vertices, faces = mesh.vertices, mesh.faces
        if self.triangles is not None:
            vertices, faces = decimated(vertices, faces, self.triangles)
        steps = np.round((vertices.clip(-1, 1) + 1) / 2 * self._max_step)
        # Merge vertices rounded to one, and remove faces of no height.
        self._set_mesh(*clean_mesh(steps, faces, str(mesh_ply))[:2])

    @property
    def _max_step(self) -> int:
        return (1 << self.bits) - 1

    def _set_mesh(self, steps: np.ndarray, faces: np.ndarray) -> None:
        self._steps, self._faces = steps.astype(np.int64), faces
        vertices = (steps / self._max_step * 2 - 1).astype(np.float32)
        self._tracer = Tracer(vertices, faces.astype(np.int32))

    def forward(self, origins: Tensor, directions: Tensor, dtype: torch.dtype) -> Tensor:
        t, _ = self._tracer.first_hit(origins.contiguous().numpy(), directions.contiguous().numpy())
        return torch.from_numpy(np.minimum(t, np.float32(LIT)))

    def lit(self, rays: SphereRays, d: Tensor, dtype: torch.dtype) -> Callable[[float], Tensor]:
        """See `ShadowNetwork.lit`: free rays from points to the light.

        The depth bias moves the point towards the light.
        """
        s = torch.minimum(rays.s, rays.chord)
        towards = (-d).expand(len(s), 3).contiguous().numpy()

        def lit(depth_bias: float) -> Tensor:
            start = rays.origins + (s - depth_bias)[:, None] * d
            return torch.from_numpy(~self._tracer.occluded(start.numpy(), towards))

        return lit

    def resident_bytes(self) -> int:
        """See `ShadowNetwork.resident_bytes`: Embree's memory."""
        count = len(self._faces)
        return VERTEX_BYTES * len(self._steps) + (FACE_BYTES + TREE_BYTES) * count

    def stored(self) -> dict[str, Tensor]:
        """See `ShadowNetwork.stored`; indices packed in the fewest bits."""
        if self.storage == "coded":
            return {"mesh": torch.from_numpy(coded(self._steps, self._faces, self.bits))}
        counts = len(self._steps), len(self._faces)
        return {
            "counts": torch.tensor(counts, dtype=torch.int32),
            "vertices": pack_integers(self._steps, self.bits),
            "faces": pack_integers(self._faces, _bits_for(counts[0])),
        }

    def restore(self, tensors: dict[str, Tensor]) -> None:
        if self.storage == "coded":
            steps, faces = decoded(tensors["mesh"].numpy())
            if steps.min(initial=0) < 0 or steps.max(initial=0) > self._max_step:
                raise ValueError(f"vertices beyond {self.bits} bits")
        else:
            steps, faces = self._unpacked(tensors)
        if len(faces) == 0 or faces.max() >= len(steps):  # Embree would read beyond its vertices
            raise ValueError(f"faces with vertices beyond its {len(steps)}")
        self._set_mesh(steps, faces)

    def _unpacked(self, tensors: dict[str, Tensor]) -> tuple[np.ndarray, np.ndarray]:
        vertices, faces = tensors["counts"].tolist()
        steps = unpack_integers(tensors["vertices"], self.bits, 3 * vertices).reshape(-1, 3)
        faces = unpack_integers(tensors["faces"], _bits_for(vertices), 3 * faces).reshape(-1, 3)
        return steps, faces


def _bits_for(count: int) -> int:
    """Bits of an index below `count`: ⌈log₂ count⌉."""
    return max(count - 1, 1).bit_length()
