"""Ray queries on one triangle mesh, by Embree."""

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from neural_shadows.scenes.embree_packets import LIBRARY, EmbreePackets

NEARLY_ALL = 1 - 1e-4  # share of a segment up to its target


class Tracer:
    """Embree's acceleration structure of a mesh; safe for threads.

    Embree works in float32 and releases the GIL while it traces, so that threads over
    chunks of rays scale with the cores.

    Args:
        vertices: (V, 3) positions, float32.
        faces: (F, 3) vertex indices, int32.
    """

    def __init__(self, vertices: np.ndarray, faces: np.ndarray):
        self._rays = (EmbreePackets if LIBRARY else EmbreeSingly)(vertices, faces)

    def first_hit(self, origins: np.ndarray, directions: np.ndarray):
        """Nearest hit of each ray o + t d, t > 0.

        Args:
            origins, directions: (n, 3) float32; t comes in units of |d|.

        Returns:
            t: (n,) float32, ∞ where nothing is hit.
            face: (n,) int32 index of the triangle, −1 where nothing is hit.
        """
        t, face, _, _ = self._rays.first_hit(origins, directions)
        return t, face

    def first_hit_barycentric(self, origins: np.ndarray, directions: np.ndarray):
        """Nearest hit of each ray o + t d, in barycentric coordinates.

        Args:
            origins, directions: (n, 3) float32.

        Returns:
            hit: (n,) bool.
            face: (n,) int32 index of the triangle; u, v: (n,) float32, the weights of its
            second and third vertex. Meaningless where nothing is hit.
        """
        _, face, u, v = self._rays.first_hit(origins, directions)
        return face >= 0, face, u, v

    def occluded(self, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Occlusion of each ray o + t d, t > 0.

        Takes (n, 3) float32 arrays; returns (n,) bool."""
        return self._rays.occluded(origins, directions)

    def blocked(self, points: np.ndarray, to_target: np.ndarray) -> np.ndarray:
        """Occlusion between each point and its target, (n,) bool.

        Args:
            points, to_target: (n, 3) float32; `to_target` is the vector from a point to its target,
                not of unit length. Its last 1e-4 is ignored: a target may lie on a surface.
        """
        return self._rays.occluded(points, to_target, NEARLY_ALL)

    def free_shares(self, points: np.ndarray, to_target: np.ndarray) -> np.ndarray:
        """Unoccluded share of each segment to its target, (n,) float32.

        Below `NEARLY_ALL` where `blocked`, at it elsewhere.

        Args:
            points, to_target: see `blocked`.
        """
        t, *_ = self._rays.first_hit(points, to_target, NEARLY_ALL)
        return np.minimum(t, np.float32(NEARLY_ALL))


class EmbreeSingly:
    """Substitute of `EmbreePackets` without the library: single rays, equal results."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray):
        self._scene = EmbreeScene()
        TriangleMesh(
            self._scene,
            np.ascontiguousarray(vertices, np.float32),
            np.ascontiguousarray(faces, np.int32),
        )
        # Embree builds its tree on the first query: query before threads share it.
        self.occluded(np.zeros((1, 3), np.float32), np.array([[0, 0, 1]], np.float32))

    def occluded(self, origins, directions, end: float | None = None) -> np.ndarray:
        return self._scene.run(origins, directions, query="OCCLUDED", dists=end) >= 0

    def first_hit(self, origins, directions, end: float | None = None):
        hit = self._scene.run(origins, directions, query="INTERSECT", output=1, dists=end)
        face = hit["primID"]
        return np.where(face >= 0, hit["tfar"], np.float32(np.inf)), face, hit["u"], hit["v"]
