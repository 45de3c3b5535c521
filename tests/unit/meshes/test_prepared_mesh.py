import numpy as np
import trimesh

from neural_shadows.meshes.prepared_mesh import all_with_normals, with_normals


def test_normals_of_all_meshes_at_once_are_those_of_each():
    """To the bit: frames that were rendered before stay as they are."""
    shapes = [trimesh.creation.icosphere(2), trimesh.creation.box(), trimesh.creation.cone(1, 2)]
    meshes = [(np.float32(shape.vertices), np.int32(shape.faces)) for shape in shapes]
    together = all_with_normals(meshes)
    assert len(together) == len(meshes)
    for found, mesh in zip(together, meshes):
        for name, wanted in vars(with_normals(*mesh)).items():
            assert getattr(found, name).dtype == wanted.dtype
            assert np.array_equal(getattr(found, name), wanted), name


def test_normals_are_those_of_trimesh():
    """To the bit, as rendered frames depend on them."""
    shapes = [trimesh.creation.icosphere(3), trimesh.creation.box(), trimesh.creation.cone(1, 2)]
    for shape in shapes:
        for vertices in (shape.vertices.view(np.ndarray), np.float32(shape.vertices)):
            mesh = with_normals(vertices, shape.faces)
            corners = vertices[shape.faces]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            angles = trimesh.triangles.angles(corners)
            weights = (len(vertices), shape.faces, normals, angles)
            expected = trimesh.geometry.weighted_vertex_normals(*weights)
            assert np.array_equal(mesh.vertex_normals, np.float32(expected))
