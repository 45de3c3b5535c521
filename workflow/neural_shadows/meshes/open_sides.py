"""Detection of sheets: open meshes without an inside."""

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from neural_shadows.meshes.uniform_points import uniform_points

_POINTS, _RAYS = 1000, 32
_OFFSET = 1e-4  # of ray origins from the surface, sphere radii

# Closed meshes and scans with holes are below 0.03 (the bunny's base 0.012, the teapot's patches
# 0.009, a ball without 2.5 % of its surface 0.022); a box without its lid has 0.20, a hemisphere
# 0.37, the landscape 0.56 and a flat sheet 1.
_LEAST_ESCAPED = 0.1


def is_sheet(vertices: np.ndarray, faces: np.ndarray) -> bool:
    """Check for visibility of both sides from far away.

    32 rays start on each side of 1000 surface points, spread over the hemisphere. The measure is the
    share without a hit, of the side with the smaller share, averaged over points. It is independent of
    the winding of faces.

    Args:
        vertices: (V, 3) in normalised space.
        faces: (F, 3) indices into them.
    """
    scene = EmbreeScene()
    TriangleMesh(scene, np.float32(vertices), np.int32(faces))
    rng = np.random.default_rng(0)
    points, face = uniform_points(vertices, faces, _POINTS, rng)
    a, b, c = (vertices[faces[face, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    directions = rng.normal(size=(_RAYS, _POINTS, 3))
    directions *= np.sign((directions * normals).sum(axis=2))[..., None]
    escaped = []
    for side in (1, -1):
        origins = np.broadcast_to(points + side * _OFFSET * normals, directions.shape)
        rays = origins.reshape(-1, 3), side * directions.reshape(-1, 3)
        hit = scene.run(*map(np.float32, rays), query="OCCLUDED") >= 0
        escaped.append(1 - hit.reshape(_RAYS, _POINTS).mean(axis=0))
    return bool(np.minimum(*escaped).mean() > _LEAST_ESCAPED)
