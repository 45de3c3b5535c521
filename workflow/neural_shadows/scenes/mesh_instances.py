"""Many copies of few meshes, each where it stands: what rays meet, exactly, by Embree.

embreex does not offer Embree's instances, so each copy is asked in turn, in its object's space.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numba import njit

from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.scenes.instance_tree import over
from neural_shadows.scenes.tracing import NEARLY_ALL, Tracer

_SLACK = 1e-5  # of a box's size, for roundings


class MeshInstances:
    """Meshes that stand in a scene.

    Args:
        kinds: (n,) which of the meshes each instance is of.
        placements: (n, 4, 4) from the mesh's space to the scene's, invertible and affine.
    """

    def __init__(self, meshes: Sequence[PreparedMesh], kinds: np.ndarray, placements: np.ndarray):
        self._meshes, self._kinds, self._placements = meshes, kinds, placements
        self._tracers = [Tracer(mesh.vertices, mesh.faces) for mesh in meshes]
        self._boxes = np.array([_box(meshes[kind], one) for kind, one in zip(kinds, placements)])

    def first_hit(self, origins: np.ndarray, directions: np.ndarray):
        """Nearest hit of each ray o + t d, t > 0.

        Args:
            origins, directions: (n, 3) float32.

        Returns:
            t: (n,) float32, ∞ where nothing is hit. n_g: (n, 3) float32, unit normals of the faces.
        """
        t = np.full(len(origins), np.inf, np.float32)
        normals = np.zeros((len(origins), 3), np.float32)
        for one, rays, o, d in self._asked(origins, directions, t):
            kind = self._kinds[one]
            found, face = self._tracers[kind].first_hit(o, d)
            nearer = found < t[rays]
            t[rays[nearer]] = found[nearer]
            n_g = self._meshes[kind].face_normals[face[nearer]]
            n_g = n_g @ np.linalg.inv(self._placements[one, :3, :3])
            normals[rays[nearer]] = n_g / np.linalg.norm(n_g, axis=1, keepdims=True)
        return t, normals

    def occluded(self, points: np.ndarray, towards: np.ndarray) -> np.ndarray:
        """See `Tracer.occluded`."""
        return self._hidden(points, towards, np.float32(np.inf), Tracer.occluded)

    def blocked(self, points: np.ndarray, ways: np.ndarray) -> np.ndarray:
        """See `Tracer.blocked`."""
        return self._hidden(points, ways, np.float32(NEARLY_ALL), Tracer.blocked)

    def _hidden(self, points, ways, end, asked) -> np.ndarray:
        ends = np.full(len(points), end)
        for one, rays, o, d in self._asked(points, ways, ends):
            ends[rays[asked(self._tracers[self._kinds[one]], o, d)]] = -1
        return ends < 0

    def _asked(
        self, origins, ways, ends
    ) -> Iterator[tuple[int, np.ndarray, np.ndarray, np.ndarray]]:
        """Of each instance the rays that meet its box before their end, and these in its space."""
        for one, box in enumerate(self._boxes):
            rays = _meeting(box, origins, ways, ends)
            if len(rays):
                way_in = np.linalg.inv(self._placements[one])
                o = origins[rays] @ way_in[:3, :3].T + way_in[:3, 3]
                d = ways[rays] @ way_in[:3, :3].T
                yield one, rays, o.astype(np.float32), d.astype(np.float32)


def _box(mesh: PreparedMesh, placement: np.ndarray) -> np.ndarray:
    """Round an instance: (6,) float64, lowest and highest corner."""
    low, high = mesh.vertices.min(0), mesh.vertices.max(0)
    middle = placement[:3, :3] @ ((low + high) / 2) + placement[:3, 3]
    half = np.abs(placement[:3, :3]) @ ((high - low) / 2)
    half += _SLACK * half.max()
    return np.concatenate([middle - half, middle + half])


@njit(cache=True, nogil=True)
def _meeting(box, origins, ways, ends):
    """Which rays (k,) int64 meet a box before their ends, in ways."""
    found, count = np.empty(len(origins), np.int64), 0
    for ray in range(len(origins)):
        begin, end = np.float64(0), np.float64(ends[ray])
        for k in range(3):
            way_over, place = over(np.float64(ways[ray, k])), origins[ray, k]
            a, b = (box[k] - place) * way_over, (box[k + 3] - place) * way_over
            begin, end = max(begin, min(a, b)), min(end, max(a, b))
        if begin <= end:
            found[count] = ray
            count += 1
    return found[:count]
