"""Reading, cleaning and normalising meshes, the broken ones included."""

import gzip
import json
from hashlib import sha256

import numpy as np
import pytest
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.meshes import cleaning as mesh_module
from neural_shadows.meshes.cleaning import clean_mesh
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.meshes.reading import read_mesh

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
TETRAHEDRON_FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
SINGLE_TRIANGLE_OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def ascii_ply(vertices, faces) -> str:
    rows = [" ".join(map(str, vertex)) for vertex in vertices]
    rows += [" ".join(map(str, [len(face), *face])) for face in faces]
    return "\n".join(
        [
            "ply",
            "format ascii 1.0",
            "comment element face 99",
            f"element vertex {len(vertices)}",
            *(f"property double {axis}" for axis in "xyz"),
            f"element face {len(faces)}",
            "comment list of corners",
            "property list uchar int vertex_indices",
            "end_header",
            *rows,
            "",
        ]
    )


def binary_ply(vertices, faces) -> bytes:
    return trimesh.Trimesh(vertices, faces, process=False).export(file_type="ply")


def save(path, content):
    content = content.encode() if isinstance(content, str) else content
    path.write_bytes(gzip.compress(content) if path.suffix == ".gz" else content)
    return path


def prepare(tmp_path, content, suffix=".ply", name="thing"):
    source = save(tmp_path / f"source{suffix}", content)
    report = prepare_mesh(
        source, tmp_path / "out" / "m.ply", tmp_path / "out" / "m.json", name=name
    )
    return report, read_prepared(tmp_path / "out" / "m.ply")


# --- reading -----------------------------------------------------------------------------


@pytest.mark.parametrize("gz", ["", ".gz"])
@pytest.mark.parametrize("kind", ["ply", "obj", "stl", "glb"])
def test_reads_each_format(tmp_path, kind, gz):
    content = trimesh.Trimesh(TETRAHEDRON, TETRAHEDRON_FACES, process=False).export(file_type=kind)
    vertices, faces = read_mesh(save(tmp_path / f"Mesh.v1.{kind.upper()}{gz}", content))
    assert vertices.dtype == np.float64
    assert faces.dtype == np.int64
    # the same triangles, corner by corner (STL has no shared vertices)
    np.testing.assert_array_equal(vertices[faces], TETRAHEDRON[TETRAHEDRON_FACES])


@pytest.mark.parametrize("endian", ["<", ">"])
def test_reads_binary_ply_of_either_byte_order_with_other_columns(tmp_path, endian):
    points = np.zeros(4, dtype=[("xyz", f"{endian}f8", 3), ("quality", "u1")])
    points["xyz"] = TETRAHEDRON + 1e6 + 1 / 3
    faces = np.zeros(4, dtype=[("n", "u1"), ("corners", f"{endian}i4", 3)])
    faces["n"], faces["corners"] = 3, TETRAHEDRON_FACES
    header = ascii_ply(points, faces).split("end_header")[0]
    header = header.replace("ascii", f"binary_{'little' if endian == '<' else 'big'}_endian")
    header = header.replace("double z", "double z\nproperty uchar quality")
    content = header.encode() + b"end_header\n" + points.tobytes() + faces.tobytes()
    vertices, faces = read_mesh(save(tmp_path / "m.ply", content))
    np.testing.assert_array_equal(vertices, TETRAHEDRON + 1e6 + 1 / 3)
    np.testing.assert_array_equal(faces, TETRAHEDRON_FACES)


def test_texture_coordinates_do_not_copy_the_vertices_of_a_ply(tmp_path):
    content = ascii_ply(TETRAHEDRON, TETRAHEDRON_FACES).replace(
        "vertex_indices", "vertex_indices\nproperty list uchar float texcoord"
    )
    header, rows = content.split("end_header\n")
    rows = rows.splitlines()
    rows[4:] = [f"{row} 6 0 {i} 1 {i} 1 {i + 1}" for i, row in enumerate(rows[4:])]
    path = save(tmp_path / "m.ply", "\n".join([f"{header}end_header", *rows, ""]))
    vertices, faces = read_mesh(path)
    np.testing.assert_array_equal(vertices, TETRAHEDRON)
    np.testing.assert_array_equal(faces, TETRAHEDRON_FACES)


def test_polygons_become_triangles(tmp_path):
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-0.5, 0.5, 0]], dtype=float)
    obj = "".join(f"v {x} {y} {z}\n" for x, y, z in square) + "f 1 2 3 4\nf 1 4 5\nf 1 2 3 4 5\n"
    ply = ascii_ply(square, [[0, 1, 2, 3], [0, 3, 4], [0, 1, 2, 3, 4]])
    for path in save(tmp_path / "m.obj", obj), save(tmp_path / "m.ply", ply):
        vertices, faces = read_mesh(path)
        a, b, c = vertices[faces].swapaxes(0, 1)
        normals = np.cross(b - a, c - a) / 2
        assert len(faces) == 2 + 1 + 3
        assert (normals[:, 2] > 0).all()
        assert normals[:, 2].sum() == pytest.approx(1 + 0.25 + 1.25)


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


def test_obj_relative_indices_count_from_their_line(tmp_path):
    text = (
        "# two triangles\r\nmtllib no_such_file.mtl\n\nvt 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0 1 0 0\n"
        "usemtl a\nf -3/1 -2/1 -1/1\nv\t0 0 5\n  v 1 0 5\nv 0 1 5\nusemtl b\nf -3//1 \\\n -2 6\n"
    )
    vertices, faces = read_mesh(save(tmp_path / "m.obj", text))
    assert len(vertices) == 6
    np.testing.assert_array_equal(faces, [[0, 1, 2], [3, 4, 5]])
    np.testing.assert_array_equal(vertices[:, 2], [0, 0, 0, 5, 5, 5])


PLY = ascii_ply(TETRAHEDRON, TETRAHEDRON_FACES)
QUADS = ascii_ply(TETRAHEDRON, [[0, 1, 2, 3]] * 4)
BINARY = binary_ply(TETRAHEDRON, TETRAHEDRON_FACES)
BOX = trimesh.creation.box()


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("m.fbx", PLY, "one of .ply, .obj, .stl, .glb"),
        ("m", PLY, "one of .ply, .obj, .stl, .glb"),
        ("ply", PLY, "one of .ply, .obj, .stl, .glb"),
        ("m.pkl", b"\x80\x04.", "one of .ply, .obj, .stl, .glb"),
        ("empty.ply", "", "is empty"),
        ("empty.ply.gz", "", "is empty"),
        ("empty.obj", "", "is empty"),
        ("garbage.ply", b"\x00\x01\x02", "cannot be read as PLY"),
        ("garbage.obj", b"hello\n", "no triangles"),
        ("garbage.stl", b"hello\n", "nor is it text"),
        ("garbage.glb", b"glTF" + bytes(100), "cannot be read as GLB"),
        ("header_only.ply", PLY[: PLY.index("end_header")], "cannot be read as PLY"),
        ("no_rows.ply", PLY[: PLY.index("end_header") + 11], "4 of vertex, there are 0 rows"),
        ("no_faces.ply", ascii_ply(TETRAHEDRON, []), "no triangles"),
        ("no_mesh.ply", ascii_ply([], []), "no triangles"),
        ("cut_row.ply", PLY[:-5], "the face '3 1' is cut"),
        ("cut_rows.ply", PLY[:-9], "truncated: its header says 4 of face, there are 3 rows"),
        ("cut_vertices.ply", PLY[:-45], "truncated"),
        ("cut_quads.ply", QUADS[:-3], "the face '4 0 1 2' is cut"),
        ("cut_binary.ply", BINARY[:-5], "cannot be read as PLY"),
        ("cut_binary_vertices.ply", BINARY[:-70], "cannot be read as PLY"),
        ("cut.stl", BOX.export(file_type="stl")[:-7], "677 bytes where"),
        ("cut.glb", BOX.export(file_type="glb")[:-7], "cannot be read as GLB"),
        ("words.ply", PLY.replace("0.0 1.0", "zero one"), "cannot be read as PLY"),
        ("index.ply", PLY.replace("3 1 2 3", "3 1 2 4"), r"face 3 .* \[1, 2, 4\] of 4"),
        ("negative.ply", PLY.replace("3 1 2 3", "3 1 2 -1"), r"face 3 .* \[1, 2, -1\] of 4"),
        ("cloud.obj", "v 0 0 0\nv 1 0 0\n", "no triangles"),
        ("index.obj", SINGLE_TRIANGLE_OBJ + "f 1 2 4\n", r"face 1 .* \[0, 1, 3\] of 3"),
        ("relative.obj", SINGLE_TRIANGLE_OBJ + "f -1 -2 -4\n", r"face 1 .* \[2, 1, -1\] of 3"),
        ("zero.obj", SINGLE_TRIANGLE_OBJ + "f 0 1 2\n", "the line 'f 0 1 2'"),
        ("two.obj", SINGLE_TRIANGLE_OBJ + "f 1 2\n", "the line 'f 1 2'"),
        ("flat.obj", "v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "the line 'v 0 0'"),
        ("words.obj", SINGLE_TRIANGLE_OBJ + "v a b c\n", "the line 'v a b c'"),
        ("not_gzip.ply.gz", None, "compressed data is damaged"),
        ("cut_gzip.ply.gz", gzip.compress(PLY.encode())[:-20], "compressed data is damaged"),
    ],
)
def test_refuses_bad_files_in_one_line(tmp_path, name, content, reason):
    path = tmp_path / name
    if content is None:
        path.write_text(PLY)
    elif isinstance(content, bytes):
        path.write_bytes(content)
    else:
        save(path, content)
    with pytest.raises(InputError, match=reason) as caught:
        read_mesh(path)
    message = str(caught.value)
    assert "\n" not in message
    assert str(path) in message
    assert len(message) < 400 + len(str(path))


def test_refuses_an_index_past_the_end_of_its_part_of_a_scene(tmp_path):
    # Joined to the next part, index 3 would be a vertex of that one.
    parts = {
        name: trimesh.Trimesh(TETRAHEDRON[:3] + offset, [[0, 1, 2]], process=False)
        for name, offset in (("a", 0), ("b", 5))
    }
    content = trimesh.Scene(parts).export(file_type="glb")
    good = np.array([0, 1, 2], dtype="<u4").tobytes()
    assert content.count(good) >= 1
    path = save(tmp_path / "m.glb", content.replace(good, np.array([0, 1, 3], "<u4").tobytes()))
    with pytest.raises(InputError, match=r"\[0, 1, 3\] of 3"):
        read_mesh(path)


def test_refuses_missing_files_and_folders(tmp_path):
    with pytest.raises(InputError, match=r"nothing.ply: no such file"):
        read_mesh(tmp_path / "nothing.ply")
    (tmp_path / "folder.ply").mkdir()
    for folder in tmp_path, tmp_path / "folder.ply":
        with pytest.raises(InputError, match="is a folder"):
            read_mesh(folder)


def test_bounds_decompression(tmp_path, monkeypatch):
    bomb = save(tmp_path / "bomb.ply.gz", PLY + " " * 1_000_000)
    assert bomb.stat().st_size < 5_000
    monkeypatch.setattr(mesh_module, "MAX_BYTES", 100_000)
    with pytest.raises(InputError, match="more than 100,000 bytes"):
        read_mesh(bomb)


# --- cleaning ----------------------------------------------------------------------------


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_refuses_vertices_that_are_not_finite(bad):
    vertices = TETRAHEDRON.copy()
    vertices[2, 1] = bad
    with pytest.raises(InputError, match=r"mesh thing: vertex 2 .*0\.0, (nan|-?inf), 0\.0"):
        clean_mesh(vertices, TETRAHEDRON_FACES, "thing")


@pytest.mark.parametrize(
    "content",
    [
        ascii_ply([[0, 0, 0], ["nan", 0, 0], [0, 1, 0]], [[0, 1, 2]]),
        SINGLE_TRIANGLE_OBJ.replace("1 0 0", "nan 0 0"),
    ],
)
def test_nan_in_a_file(tmp_path, content):
    suffix = ".ply" if content.startswith("ply") else ".obj"
    with pytest.raises(InputError, match=r"source\.\w+: vertex 1 \(counted from 0\) is \(nan"):
        prepare(tmp_path, content, suffix)


@pytest.mark.parametrize(
    "vertices",
    [
        np.outer([0, 1, 2, 5], [1, 2, 3]),  # collinear
        np.ones((4, 3)),  # a point
        [[0, 0, 0], [1, 0, 0], [2, 1e-9, 0], [3, 0, 0]],  # lower than float32 can tell
    ],
)
@pytest.mark.parametrize("unit", [1e-6, 1, 1e6])
def test_refuses_meshes_without_area(vertices, unit):
    with pytest.raises(InputError, match="mesh thing: .*(zero area|diagonal 0)"):
        clean_mesh(np.array(vertices) * unit, TETRAHEDRON_FACES, "thing")


def test_a_single_triangle_is_a_mesh(tmp_path):
    report, mesh = prepare(tmp_path, SINGLE_TRIANGLE_OBJ, ".obj")
    assert (report["vertices"], report["faces"]) == (3, 1)
    assert (report["watertight"], report["open_edges"], report["bodies"]) == (False, 3, 1)
    assert report["centre"] == pytest.approx([0.5, 0.5, 0])
    assert report["radius"] == pytest.approx(0.5**0.5)
    np.testing.assert_array_equal(mesh.face_normals, [[0, 0, 1]])
    np.testing.assert_array_equal(mesh.vertex_normals, [[0, 0, 1]] * 3)


UNITS = pytest.mark.parametrize(
    ("unit", "offset"), [(1, 0), (1e-6, 0), (1e3, 0), (1e6, 0), (1, 1e6), (1e-3, 1e3), (1e150, 0)]
)


@UNITS
def test_cleans_everything_at_once_in_any_unit(unit, offset):
    """A tetrahedron with a seam, a near-seam, and every kind of bad face."""
    extra = [
        TETRAHEDRON[1],  # 4: a copy of 1
        TETRAHEDRON[2] + 5e-9,  # 5: near 2, within 1e-8 of the diagonal (1.7)
        [0.5, 0, 0],  # 6: on the edge 0-1
        [9, 9, 9],  # 7: of no face
        TETRAHEDRON[3] + 1e-6,  # 8: near 3 but not the same
    ]
    faces = [
        [0, 2, 1],
        [0, 4, 3],
        [0, 3, 5],
        [4, 5, 3],
        [1, 3, 0],  # a duplicate of 1
        [2, 0, 1],  # a duplicate of 0
        [3, 2, 1],  # 3 with the opposite winding
        [0, 0, 1],  # an index twice
        [1, 4, 3],  # twice after merging
        [0, 6, 1],  # collinear
    ]
    vertices = np.vstack([TETRAHEDRON, extra]) * unit + offset
    cleaned, faces, report = clean_mesh(vertices, np.array(faces), "thing")
    np.testing.assert_array_equal(cleaned, TETRAHEDRON * unit + offset)
    np.testing.assert_array_equal(faces, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    assert report == {
        "source_vertices": 9,
        "source_faces": 10,
        "vertices": 4,
        "faces": 4,
        "merged_vertices": 2,
        "unreferenced_vertices": 3,  # 7 and 8, and 6 once its face is gone
        "degenerate_faces": 3,
        "duplicate_faces": 3,
        "watertight": True,
        "open_edges": 0,
        "non_manifold_edges": 0,
        "bodies": 1,
    }


@UNITS
def test_keeps_what_is_small_but_real(unit, offset):
    # One corner cut off at 1e-6 of the size.
    vertices = np.vstack([TETRAHEDRON, [[0, 0, 1 - 1e-6]]]) * unit + offset
    faces = [[0, 2, 1], [0, 1, 4], [0, 4, 2], [1, 2, 3], [1, 3, 4], [2, 4, 3]]
    _, _, report = clean_mesh(vertices, np.array(faces), "thing")
    assert (report["vertices"], report["faces"], report["watertight"]) == (5, 6, True)


def test_merges_wherever_the_pair_lies():
    """A grid alone would leave pairs on both sides of a cell's border."""
    ball = trimesh.creation.icosphere(3)
    soup = ball.vertices[ball.faces].reshape(-1, 3)
    # the diagonal is 3.46: moved apart by at most 3.46e-9 * sqrt(3), a sixth of the limit
    soup = soup + np.random.default_rng(0).uniform(-1.7e-9, 1.7e-9, soup.shape)
    _, faces, report = clean_mesh(soup, np.arange(len(soup)).reshape(-1, 3), "ball")
    assert report["vertices"] == len(ball.vertices)
    assert report["merged_vertices"] == len(soup) - len(ball.vertices)
    assert report["watertight"]
    # merged into the first copy, in the order of the file
    assert faces[0].tolist() == [0, 1, 2]


def test_many_copies_of_one_vertex_cost_no_pairs():
    # 20,000 triangles around one apex, each with its own copy of it
    angles = np.linspace(0, 2 * np.pi, 20_001)
    rim = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    rim[-1] = rim[0]
    corners = np.stack([np.zeros((20_000, 3)), rim[:-1], rim[1:]], axis=1)
    _, _, report = clean_mesh(corners.reshape(-1, 3), np.arange(60_000).reshape(-1, 3), "fan")
    assert (report["vertices"], report["open_edges"], report["bodies"]) == (20_001, 20_000, 1)


def test_open_meshes_and_bodies_are_reported():
    box = trimesh.creation.box()
    vertices = np.vstack([box.vertices, box.vertices + 5])
    faces = np.vstack([box.faces, box.faces + 8])[1:]
    _, _, report = clean_mesh(vertices, faces, "boxes")
    assert (report["watertight"], report["open_edges"], report["bodies"]) == (False, 3, 2)
    # three sheets that share one edge
    sheets = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0]], dtype=float)
    _, _, report = clean_mesh(sheets, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]]), "sheets")
    assert (report["open_edges"], report["non_manifold_edges"]) == (6, 1)


# --- normalised space --------------------------------------------------------------------


def seamed_sphere_obj() -> str:
    """A sphere by longitude and latitude, with the vertices of its seam and poles repeated."""
    rows, columns = 8, 12
    lines, faces = [], []
    for i in range(rows + 1):
        for j in range(columns + 1):
            theta, phi = np.pi * i / rows, 2 * np.pi * (j % columns) / columns
            x, y, z = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)
            z = round(z, 12)
            x, y = (0, 0) if i in (0, rows) else (x, y)
            lines.append(f"v {x:.9f} {y:.9f} {z:.9f}\nvt {j / columns} {i / rows}")
    for i in range(rows):
        for j in range(columns):
            a = i * (columns + 1) + j + 1
            b, c, d = a + columns + 1, a + columns + 2, a + 1
            faces.append("f " + " ".join(f"{index}/{index}" for index in (a, b, c, d)))
    return "\n".join([*lines, *faces, ""])


def test_seams_merge_into_a_closed_surface(tmp_path):
    report, mesh = prepare(tmp_path, seamed_sphere_obj(), ".obj")
    assert report["source_vertices"] == 9 * 13
    assert report["vertices"] == 7 * 12 + 2
    assert report["merged_vertices"] == 9 * 13 - (7 * 12 + 2)
    assert report["degenerate_faces"] == 2 * 12
    assert report["watertight"]
    # Normals of a sphere about the origin point along the position.
    cosines = (mesh.vertex_normals * mesh.vertices).sum(axis=1)
    assert cosines.min() > 0.99


def test_report_and_files(tmp_path):
    report, mesh = prepare(tmp_path, PLY, ".ply.gz", name="corner")
    assert json.loads((tmp_path / "out" / "m.json").read_text()) == report
    assert report["name"] == "corner"
    assert report["source"] == "source.ply.gz"
    assert report["sha256"] == sha256((tmp_path / "source.ply.gz").read_bytes()).hexdigest()
    assert str(tmp_path) not in json.dumps(report)
    # The face (1, 2, 3) is equilateral with side sqrt(2), and its circumcircle a great circle.
    assert report["centre"] == pytest.approx([1 / 3] * 3)
    assert report["radius"] == pytest.approx(np.sqrt(2 / 3))
    assert (report["source_vertices"], report["source_faces"]) == (4, 4)
    assert report["watertight"]
    assert mesh.vertices.dtype == mesh.vertex_normals.dtype == mesh.face_normals.dtype == "f4"
    assert mesh.faces.dtype == "i4"
    np.testing.assert_allclose(
        mesh.vertices, (TETRAHEDRON - 1 / 3) / np.sqrt(2 / 3), rtol=0, atol=1e-7
    )
    np.testing.assert_array_equal(mesh.faces, TETRAHEDRON_FACES)
    diagonal = 3**-0.5
    np.testing.assert_allclose(
        mesh.face_normals,
        [[0, 0, -1], [0, -1, 0], [-1, 0, 0], [diagonal] * 3],
        rtol=0,
        atol=1e-6,
    )


@pytest.mark.parametrize(
    ("unit", "offset", "atol"),
    [(1e-3, 0, 1e-7), (1e3, 0, 1e-7), (1e6, 0, 1e-7), (1, 1e6, 2e-7), (1e-3, [1e6, 0, -50], 1e-6)],
)
def test_normalised_vertices_do_not_depend_on_unit_or_offset(tmp_path, unit, offset, atol):
    wobbly = trimesh.creation.icosphere(3)
    shape = wobbly.vertices * (1 + 0.3 * np.sin(5 * wobbly.vertices[:, :1])) * [1, 0.5, 2]
    _, expected = prepare(tmp_path, ascii_ply(shape, wobbly.faces))
    report, mesh = prepare(tmp_path, ascii_ply(shape * unit + offset, wobbly.faces))
    np.testing.assert_allclose(mesh.vertices, expected.vertices, rtol=0, atol=atol)
    np.testing.assert_array_equal(mesh.faces, expected.faces)
    reach = np.linalg.norm(mesh.vertices.astype(float), axis=1).max()
    assert reach == pytest.approx(1, abs=1e-6)
    back = mesh.vertices * report["radius"] + np.array(report["centre"])
    np.testing.assert_allclose(back, shape * unit + offset, rtol=0, atol=2e-7 * 2 * unit + 1e-9)


def test_the_box_is_bounded_by_its_corners(tmp_path):
    box = trimesh.creation.box(extents=(2, 4, 4))
    report, mesh = prepare(tmp_path, BOX.export(file_type="stl"), ".stl")
    assert (report["source_vertices"], report["vertices"], report["faces"]) == (36, 8, 12)
    report, mesh = prepare(tmp_path, box.export(file_type="glb"), ".glb")
    assert report["radius"] == pytest.approx(3)
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices, axis=1), 1, atol=1e-6)
    # Angle weights: at a corner of a box each of three sides has 90 degrees, however it is cut.
    np.testing.assert_allclose(
        mesh.vertex_normals, np.sign(mesh.vertices) / np.sqrt(3), rtol=0, atol=1e-6
    )


def test_normals_have_unit_length_for_tiny_and_cancelling_faces(tmp_path):
    # A speck of 1e-6 beside a far vertex, and two overlapping sheets of opposite winding.
    speck = TETRAHEDRON * 1e-6
    sheets = np.array([[2, 0, 0], [2, 0, 1], [3, 0, 0], [4, 0, 0]])
    faces = np.vstack([TETRAHEDRON_FACES, [[4, 5, 6], [5, 4, 7]]])
    report, mesh = prepare(tmp_path, ascii_ply(np.vstack([speck, sheets]), faces))
    assert (report["faces"], report["bodies"]) == (6, 2)
    for normals in mesh.vertex_normals, mesh.face_normals:
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
    # The speck's vertices are on a grid of 6e-8: its normals keep their directions only.
    assert ((mesh.face_normals[:3] * [[0, 0, -1], [0, -1, 0], [-1, 0, 0]]).sum(axis=1) > 0.9).all()


def test_vertices_that_float32_brings_together_are_merged(tmp_path):
    # Already normalised. The second face is 2.9e-8 high: 1.4e-8 of the diagonal, so it is kept
    # in float64, but less than half of float32's spacing at 0.75.
    vertices = [[-1, 0, 0], [1, 0, 0], [0, 0.75, 0], [0, 0.75 + 2.9e-8, 0], [0.6, 0.75, 0]]
    faces = np.array([[0, 1, 2], [4, 2, 3]])
    _, _, report = clean_mesh(np.array(vertices), faces, "thing")
    assert (report["vertices"], report["faces"]) == (5, 2)
    report, mesh = prepare(tmp_path, ascii_ply(vertices, faces))
    assert len(mesh.faces) == report["faces"] == 1
    assert (report["source_vertices"], report["source_faces"]) == (5, 2)
    assert (report["merged_vertices"], report["unreferenced_vertices"]) == (1, 1)
    assert (report["degenerate_faces"], report["duplicate_faces"]) == (1, 0)


@pytest.mark.parametrize(
    "content",
    [
        PLY.replace("0.0 1.0", "nan 1.0"),
        PLY[:-9],
        ascii_ply([[0, 0, 0], [1, 1, 1], [2, 2, 2]], [[0, 1, 2]]),
    ],
)
def test_a_failing_run_leaves_nothing_new(tmp_path, content):
    with pytest.raises(InputError):
        prepare(tmp_path, content)
    assert not (tmp_path / "out").exists()


def test_a_run_that_fails_while_writing_leaves_the_old_files(tmp_path, monkeypatch):
    prepare(tmp_path, PLY)
    before = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}

    def full_disk(*_):
        raise OSError("No space left on device")

    monkeypatch.setattr(mesh_module, "write_json", full_disk)
    with pytest.raises(OSError, match="No space"):
        prepare(tmp_path, SINGLE_TRIANGLE_OBJ, ".obj")
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()} == before


def test_read_prepared_refuses_what_was_not_prepared(tmp_path):
    prepare(tmp_path, PLY)
    prepared = tmp_path / "out" / "m.ply"
    whole = prepared.read_bytes()
    prepared.write_bytes(whole[:-1])
    with pytest.raises(InputError, match="cannot be read as PLY"):
        read_prepared(prepared)
    inside = TETRAHEDRON[1:] * 0.9
    for vertices, faces, reason in [
        (inside * 1.2, [[0, 1, 2]], "outside the unit sphere"),
        (inside * np.nan, [[0, 1, 2]], "outside the unit sphere"),
        (inside, [[0, 1, 2], [0, 1, 1]], "face 1 has no area"),
    ]:
        prepared.write_bytes(binary_ply(vertices, faces))
        with pytest.raises(InputError, match=reason):
            read_prepared(prepared)
    with pytest.raises(InputError, match="no such file"):
        read_prepared(tmp_path / "out" / "nothing.ply")
