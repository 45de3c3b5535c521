"""From a mesh file to normalised space, and the mesh as stages read it."""

import gzip
import hashlib
import json

import numpy as np
import pytest
import trimesh
from mesh_files import TETRAHEDRON, TETRAHEDRON_FACES, WRITERS, ascii_ply, obj

from neural_shadows.meshes import thesis_meshes
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import read_prepared

PLY = ascii_ply(TETRAHEDRON, TETRAHEDRON_FACES)


def prepare(tmp_path, content, suffix=".ply", **mesh):
    source, out = tmp_path / f"source{suffix}", tmp_path / "out"
    source.write_bytes(content)
    prepare_mesh(source, out / "m.ply", out / "m.json", mesh=mesh, name="corner")
    return json.loads((out / "m.json").read_text()), read_prepared(out / "m.ply")


def test_report_and_files(tmp_path):
    report, mesh = prepare(tmp_path, gzip.compress(PLY), ".ply.gz")
    assert (report["name"], report["source"]) == ("corner", "source.ply.gz")
    digest = hashlib.sha256((tmp_path / "source.ply.gz").read_bytes()).hexdigest()
    assert report["sha256"] == digest
    assert str(tmp_path) not in json.dumps(report)
    # The face (1, 2, 3) is equilateral with side sqrt(2), and its circumcircle a great circle.
    assert report["centre"] == pytest.approx([1 / 3] * 3)
    assert report["radius"] == pytest.approx(np.sqrt(2 / 3))
    assert (report["watertight"], report["sheet"], report["thesis_mesh"]) == (True, False, False)
    expected = (TETRAHEDRON - 1 / 3) / np.sqrt(2 / 3)
    np.testing.assert_allclose(mesh.vertices, expected, rtol=0, atol=1e-7)
    np.testing.assert_array_equal(mesh.faces, TETRAHEDRON_FACES)
    normals = [[0, 0, -1], [0, -1, 0], [-1, 0, 0], [3**-0.5] * 3]
    np.testing.assert_allclose(mesh.face_normals, normals, rtol=0, atol=1e-6)


def test_the_thesis_s_meshes_are_known_and_sheets_reported(tmp_path, monkeypatch, capsys):
    assert prepare(tmp_path, PLY, generate="fence")[0]["thesis_mesh"]
    # The dragon is known by its content, wherever it is from, also compressed.
    monkeypatch.setattr(thesis_meshes, "DRAGON_SHA256", hashlib.sha256(PLY).hexdigest())
    assert prepare(tmp_path, gzip.compress(PLY), ".ply.gz", path="mine")[0]["thesis_mesh"]
    assert capsys.readouterr().out == ""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    report, _ = prepare(tmp_path, obj(square, [[0, 1, 2, 3]]), ".obj", generate="wyrm")
    assert report["sheet"] and not report["thesis_mesh"]
    assert "source.obj: an open sheet" in capsys.readouterr().out


def test_normalised_vertices_do_not_depend_on_unit_or_offset(tmp_path):
    unit, offset = 1e-3, [1e6, 0, -50]
    wobbly = trimesh.creation.icosphere(3)
    shape = wobbly.vertices * (1 + 0.3 * np.sin(5 * wobbly.vertices[:, :1])) * [1, 0.5, 2]
    _, expected = prepare(tmp_path, ascii_ply(shape, wobbly.faces))
    report, mesh = prepare(tmp_path, ascii_ply(shape * unit + offset, wobbly.faces))
    np.testing.assert_allclose(mesh.vertices, expected.vertices, rtol=0, atol=1e-6)
    np.testing.assert_array_equal(mesh.faces, expected.faces)
    back = mesh.vertices * report["radius"] + np.array(report["centre"])
    np.testing.assert_allclose(back, shape * unit + offset, rtol=0, atol=2e-7 * 2 * unit + 1e-9)


def test_seams_merge_and_normals_do_not_depend_on_the_triangulation(tmp_path):
    box = trimesh.creation.box(extents=(2, 4, 4))
    for file in ("source.stl", "source.glb"):
        content = WRITERS[file](box.vertices, box.faces)
        report, mesh = prepare(tmp_path, content, file[6:])
        assert (report["vertices"], report["faces"], report["watertight"]) == (8, 12, True)
        assert report["radius"] == pytest.approx(3)
        # Angle weights: at a corner of a box each of three sides has 90 degrees, however it is cut.
        expected = np.sign(mesh.vertices) / np.sqrt(3)
        np.testing.assert_allclose(mesh.vertex_normals, expected, rtol=0, atol=1e-6)


def test_normals_have_unit_length_for_tiny_and_cancelling_faces(tmp_path):
    # A speck of 1e-6 beside a far vertex, and two overlapping sheets of opposite winding.
    speck = TETRAHEDRON * 1e-6
    sheets = np.array([[2, 0, 0], [2, 0, 1], [3, 0, 0], [4, 0, 0]])
    faces = np.vstack([TETRAHEDRON_FACES, [[4, 5, 6], [5, 4, 7]]])
    report, mesh = prepare(tmp_path, ascii_ply(np.vstack([speck, sheets]), faces))
    assert (report["faces"], report["bodies"]) == (6, 2)
    for normals in mesh.vertex_normals, mesh.face_normals:
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)


def test_vertices_that_float32_brings_together_are_merged(tmp_path):
    # Already normalised. The second face is 2.9e-8 high: 1.4e-8 of the diagonal, so it is kept
    # in float64, but less than half of float32's spacing at 0.75.
    vertices = [[-1, 0, 0], [1, 0, 0], [0, 0.75, 0], [0, 0.75 + 2.9e-8, 0], [0.6, 0.75, 0]]
    report, mesh = prepare(tmp_path, ascii_ply(vertices, [[0, 1, 2], [4, 2, 3]]))
    assert len(mesh.faces) == report["faces"] == 1
    assert (report["source_vertices"], report["source_faces"]) == (5, 2)
    assert (report["merged_vertices"], report["unreferenced_vertices"]) == (1, 1)
    assert (report["degenerate_faces"], report["duplicate_faces"]) == (1, 0)
