"""Height map: heights of a landscape on a grid, the usual representation.

A ray ends where it crosses their surface. Nothing is trained.
"""

from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from neural_shadows.errors import InputError
from neural_shadows.meshes.prepared_mesh import PreparedMesh, read_prepared
from neural_shadows.networks.object_space.shadow_network import chords
from neural_shadows.networks.untrained.untrained_network import UntrainedNetwork
from neural_shadows.representations.heights.height_marching import first_crossings
from neural_shadows.scenes.tracing import Tracer

_TYPES = {8: np.uint8, 16: np.uint16}


class HeightMapNetwork(UntrainedNetwork):
    """t_pred(o, d) at the surface between the heights, from either side.

    Args:
        up: `x`, `y` or `z`, the axis of the heights.
        resolution: heights along a side of the map, which is the mesh's rectangle across `up`.
        bits: of a height, 8 or 16, between the mesh's lowest and highest.
    """

    def __init__(self, *, up: str, resolution: int, bits: int):
        super().__init__()
        # Two horizontal axes, and up.
        self.axes = [("xyz".index(up) + k) % 3 for k in (1, 2, 0)]
        self.heights = np.zeros((resolution, resolution), _TYPES[bits])
        self.box = np.zeros((2, 3), np.float32)

    def prepare(self, mesh_ply: Path) -> None:
        """Sample the mesh's heights on the grid.

        Raises:
            InputError: the mesh is no height field over its rectangle across `up`.
        """
        mesh = read_prepared(mesh_ply)
        points = mesh.vertices[:, self.axes]
        self.box = np.stack([points.min(0), points.max(0)])
        heights = _sampled_heights(mesh, self.axes, self.box, len(self.heights))
        # One height everywhere: no gaps, overlaps or walls.
        area = np.prod(np.ptp(self.box[:, :2], axis=0))
        covers_once = abs(_projected_area(points[mesh.faces]) - area) < 1e-3 * area
        walls = np.abs(mesh.face_normals[:, self.axes[2]]).min() < 1e-6
        if not covers_once or walls or not np.isfinite(heights).all():
            raise InputError(
                f"{mesh_ply}: no height field along {'xyz'[self.axes[2]]}: seen from there, its "
                "faces stand upright, overlap, or do not fill a rectangle. Give another `up` or "
                "`encoding`."
            )
        share = (heights - self.box[0, 2]) / self._extent()[2]
        maximum = np.iinfo(self.heights.dtype).max
        self.heights = np.rint(share.clip(0, 1) * maximum).astype(self.heights.dtype)

    def _extent(self) -> np.ndarray:
        """Extent of the box, (3,) float64; 1 for the height of a plane."""
        extent = np.ptp(self.box.astype(np.float64), axis=0)
        return np.where(extent > 0, extent, 1)

    def forward(self, origins: Tensor, directions: Tensor, dtype: torch.dtype) -> Tensor:
        """See `ShadowNetwork.forward`; `LIT` for misses."""
        cells = len(self.heights) - 1
        scale = np.array([cells, cells, np.iinfo(self.heights.dtype).max]) / self._extent()
        o = (origins.numpy()[:, self.axes] - self.box[0].astype(np.float64)) * scale
        d = directions.numpy()[:, self.axes] * scale
        ends = chords(origins, directions).double().numpy()
        return torch.from_numpy(first_crossings(o, d, ends, self.heights))

    def resident_bytes(self) -> int:
        """See `ShadowNetwork.resident_bytes`."""
        return self.heights.nbytes + self.box.nbytes

    def stored(self) -> dict[str, Tensor]:
        """See `ShadowNetwork.stored`."""
        return {"heights": torch.from_numpy(self.heights), "box": torch.from_numpy(self.box)}

    def restore(self, tensors: dict[str, Tensor]) -> None:
        """See `ShadowNetwork.restore`."""
        heights = tensors["heights"].numpy()
        if (heights.shape, heights.dtype) != (self.heights.shape, self.heights.dtype):
            raise ValueError(f"{heights.shape} {heights.dtype} heights")
        self.heights, self.box = heights, tensors["box"].numpy()


def _projected_area(corners: np.ndarray) -> float:
    """Area of triangles (F, 3, 3), projected along the last axis."""
    a, b, c = (corners[:, k, :2].astype(np.float64) for k in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return float(np.abs(ux * vy - uy * vx).sum() / 2)


def _sampled_heights(
    mesh: PreparedMesh, axes: list[int], box: np.ndarray, resolution: int
) -> np.ndarray:
    """Highest points of the mesh on a grid, (r, r) float64; else −∞."""
    # A millionth inside the rim, where rays would miss.
    share = np.linspace(1e-6, 1 - 1e-6, resolution)
    top = float(box[1, 2]) + 0.1
    points = np.empty((resolution, resolution, 3), np.float32)
    points[..., axes[0]] = (box[0, 0] + share * np.ptp(box[:, 0]))[:, None]
    points[..., axes[1]] = box[0, 1] + share * np.ptp(box[:, 1])
    points[..., axes[2]] = top
    down = np.zeros((resolution**2, 3), np.float32)
    down[:, axes[2]] = -1
    t, _ = Tracer(mesh.vertices, mesh.faces).first_hit(points.reshape(-1, 3), down)
    return (top - t.astype(np.float64)).reshape(resolution, resolution)
