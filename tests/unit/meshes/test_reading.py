"""Mesh files of all formats, the broken ones included."""

import gzip
import io

import numpy as np
import pytest
import trimesh
from mesh_files import (
    TETRAHEDRON,
    TETRAHEDRON_FACES,
    WRITERS,
    ascii_ply,
    exported,
    obj,
)

from neural_shadows.errors import InputError
from neural_shadows.meshes.binary_ply import parse_binary_ply
from neural_shadows.meshes.reading import read_mesh


def save(path, content):
    content = content.encode() if isinstance(content, str) else content
    path.write_bytes(gzip.compress(content) if path.suffix == ".gz" else content)
    return path


@pytest.mark.parametrize("file", WRITERS)
def test_reads_each_format(tmp_path, file):
    content = WRITERS[file](TETRAHEDRON, TETRAHEDRON_FACES)
    for gz in ("", ".gz"):
        vertices, faces = read_mesh(save(tmp_path / f"Mesh.v1.{file.upper()}{gz}", content))
        assert vertices.dtype == np.float64 and faces.dtype == np.int64
        # the same triangles, corner by corner (STL has no shared vertices)
        np.testing.assert_array_equal(vertices[faces], TETRAHEDRON[TETRAHEDRON_FACES])


def test_a_prepared_mesh_is_read_as_by_trimesh():
    """Which still takes what has more properties, other polygons or an unusual end."""
    shape = trimesh.creation.icosphere(2)
    data = exported("ply", shape.vertices, shape.faces)
    vertices, faces = parse_binary_ply(data)
    expected = trimesh.load(io.BytesIO(data), file_type="ply", process=False)
    np.testing.assert_array_equal(vertices, expected.vertices)
    np.testing.assert_array_equal(faces, expected.faces)
    assert vertices.dtype == np.float64 and faces.dtype == np.int64
    corners = len(data) - 13 * len(faces)
    for other in (
        data.replace(b"float z\n", b"float z\nproperty float quality\n"),
        data.replace(b"float z", b"double z"),
        data.replace(b"little", b"big"),
        data[:-1],
        data + b"\0",
        data[:corners] + b"\4" + data[corners + 1 :],
    ):
        assert other != data and parse_binary_ply(other) is None


def test_polygons_become_triangles(tmp_path):
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-0.5, 0.5, 0]])
    polygons = [[0, 1, 2, 3], [0, 3, 4], [0, 1, 2, 3, 4]]
    for name, write in (("m.obj", obj), ("m.ply", ascii_ply)):
        vertices, faces = read_mesh(save(tmp_path / name, write(square, polygons)))
        a, b, c = vertices[faces].swapaxes(0, 1)
        areas = np.cross(b - a, c - a)[:, 2] / 2
        assert len(faces) == 2 + 1 + 3 and (areas > 0).all()
        assert areas.sum() == pytest.approx(1 + 0.25 + 1.25)


def test_glb_scenes_are_flattened_with_their_transforms(tmp_path):
    ball = trimesh.creation.icosphere(1)
    moved, mirrored = np.eye(4), np.diag([-2.0, 2, 2, 1])
    moved[:3, 3] = [10, 0, 0]
    mirrored[:3, 3] = [0, 20, 0]
    scene = trimesh.Scene(ball)
    scene.add_geometry(ball, transform=moved)
    scene.add_geometry(ball, transform=mirrored)
    scene.add_geometry(trimesh.PointCloud(np.full((3, 3), 99.0)))
    vertices, faces = read_mesh(save(tmp_path / "scene.glb", scene.export(file_type="glb")))
    assert len(faces) == 3 * len(ball.faces)
    np.testing.assert_allclose(vertices[faces].min(axis=(0, 1)), [-2, -1, -2], atol=1e-6)
    np.testing.assert_allclose(vertices[faces].max(axis=(0, 1)), [11, 22, 2], atol=1e-6)
    # The mirrored part still faces outward, so the volumes add up: 1 + 1 + 2^3.
    volume = trimesh.Trimesh(vertices, faces, process=False).volume
    assert volume == pytest.approx(10 * ball.volume, rel=1e-5)


def test_obj_lines_of_all_kinds_and_indices_relative_to_their_line(tmp_path):
    text = (
        "# two triangles\r\nmtllib no_such_file.mtl\n\nvt 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0 1 0 0\n"
        "usemtl a\nf -3/1 -2/1 -1/1 # no\nv\t0 0 5\n  v 1 0 5\nv 0 1 5\nfo 9 9 9\nf -3//1 \\\n -2 6\n"
    )
    for content in (text, text.replace("\r\n", "\n").replace("\n", "\r")):
        vertices, faces = read_mesh(save(tmp_path / "m.obj", content))
        np.testing.assert_array_equal(faces, [[0, 1, 2], [3, 4, 5]])
        np.testing.assert_array_equal(vertices[:, 2], [0, 0, 0, 5, 5, 5])


PLY = ascii_ply(TETRAHEDRON, TETRAHEDRON_FACES).decode()
BOX = trimesh.creation.box()
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
DRACO = b'{"extensionsRequired": ["KHR_draco_mesh_compression"]}'


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("m.fbx", PLY, "one of .ply, .obj, .stl, .glb"),
        ("nothing.ply", None, "cannot be read .No such file"),
        ("empty.ply.gz", b"", "is empty"),
        ("no_faces.ply", ascii_ply(TETRAHEDRON, []), "no triangles"),
        ("cut_row.ply", PLY[:-12], "7 rows instead of the header's 8"),
        ("cut.stl", BOX.export(file_type="stl")[:-7], "a truncated file"),
        ("index.ply", PLY.replace("3 1 2 3", "3 1 2 4"), r"face 3 .* \[1, 2, 4\] of 4"),
        ("index.obj", OBJ + "f 1 2 4\n", r"face 1 .* \[0, 1, 3\] of 3"),
        ("zero.obj", OBJ + "f 0 1 2\n", "the line 'f 0 1 2'"),
        (
            "draco.glb",
            b"glTF" + bytes(8) + bytes([len(DRACO), 0, 0, 0]) + b"JSON" + DRACO,
            "KHR_draco_mesh_compression",
        ),
        ("cut.ply.gz", gzip.compress(PLY.encode())[:-20], "Compressed file ended"),
        ("not_gzip.ply.gz", PLY.encode(), "Not a gzipped file"),
    ],
)
def test_refuses_bad_files_in_one_line(tmp_path, name, content, reason):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content.encode() if isinstance(content, str) else content)
    with pytest.raises(InputError, match=reason) as caught:
        read_mesh(path)
    message = str(caught.value)
    assert "\n" not in message and str(path) in message and len(message) < 400 + len(str(path))


def test_refuses_an_index_past_the_end_of_its_part_of_a_scene(tmp_path):
    # Joined to the next part, index 3 would be a vertex of that one.
    parts = [trimesh.Trimesh(TETRAHEDRON[:3] + o, [[0, 1, 2]], process=False) for o in (0, 5)]
    content = trimesh.Scene(parts).export(file_type="glb")
    good, bad = (np.array([0, 1, last], "<u4").tobytes() for last in (2, 3))
    with pytest.raises(InputError, match=r"\[0, 1, 3\] of 3"):
        read_mesh(save(tmp_path / "m.glb", content.replace(good, bad)))
