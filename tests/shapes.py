"""Small meshes and cameras for the tests of what renders."""

import numpy as np
import trimesh

from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.scenes.cameras import Viewpoint
from neural_shadows.scenes.scene import Scene, make_scene
from neural_shadows.scenes.tracing import Tracer

Y_UP = np.array([0.0, 1.0, 0.0])
AXES = [np.array(axis, float) for axis in np.concatenate([np.eye(3), -np.eye(3)])]


def prepared(shape: trimesh.Trimesh) -> tuple[PreparedMesh, Tracer]:
    """A shape, as it lies, with the normals that trimesh gives it."""
    mesh = PreparedMesh(
        vertices=np.array(shape.vertices, np.float32),
        faces=np.array(shape.faces, np.int32),
        vertex_normals=np.array(shape.vertex_normals, np.float32),
        face_normals=np.array(shape.face_normals, np.float32),
    )
    return mesh, Tracer(mesh.vertices, mesh.faces)


SPHERE_OF_LIGHTS = {"domain": "sphere", "min_elevation_deg": 20}


def scene_of(shape: trimesh.Trimesh, up=Y_UP, ground=True, light=SPHERE_OF_LIGHTS) -> Scene:
    """A scene of a shape as it lies."""
    return make_scene(prepared(shape)[0], up=up, ground=ground, light=light)


def bumpy_sphere(subdivisions: int) -> trimesh.Trimesh:
    """A sphere with bumps that shadow each other, inside the unit sphere."""
    shape = trimesh.creation.icosphere(subdivisions)
    x, y, z = shape.vertices.T
    bumps = 0.1 * np.sin(11 * x + 2) * np.sin(9 * y) * np.sin(13 * z + 1)
    shape.vertices *= (0.85 + bumps)[:, None]
    return shape


def box(*extents: float) -> trimesh.Trimesh:
    """An axis-aligned box round the origin."""
    return trimesh.creation.box(extents)


def octahedron() -> trimesh.Trimesh:
    """|x| + |y| + |z| = 1: its six vertices are on the unit sphere, exactly."""
    vertices = np.concatenate([np.eye(3), -np.eye(3)])
    faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    return trimesh.Trimesh(vertices, faces, process=False)


def sheet(height: float, half: float, winding: int = 1) -> trimesh.Trimesh:
    """A horizontal square; winding 1 turns its normal up."""
    corners = [[-half, height, -half], [-half, height, half], [half, height, half]]
    faces = np.array([[0, 1, 2], [0, 2, 3]])[:, ::winding]
    return trimesh.Trimesh([*corners, [half, height, -half]], faces, process=False)


def hills(cells: int = 32) -> trimesh.Trimesh:
    """An open height field of cells² squares, whose hills shadow each other."""
    x, z = (axis.ravel() for axis in np.meshgrid(*[np.linspace(-1, 1, cells + 1)] * 2))
    corner = np.arange(len(x)).reshape(cells + 1, -1)[:-1, :-1].reshape(-1, 1)
    faces = [corner + [0, cells + 1, 1], corner + [1, cells + 1, cells + 2]]
    heights = 0.2 * np.sin(5 * x) * np.cos(4 * z)
    return trimesh.Trimesh(np.stack([x, heights, z], 1), np.concatenate(faces), process=False)


def unit(*vector: float) -> np.ndarray:
    return np.array(vector) / np.linalg.norm(vector)


def looking(eye, light, target=(0.0, 0.0, 0.0), fov=45.0) -> Viewpoint:
    """A camera with y up."""
    eye, target = np.array(eye, float), np.array(target, float)
    return Viewpoint("surface", 0, eye, target, Y_UP, fov, np.asarray(light, float))
