"""Meshes as they are found: whatever is in the file, it is read rightly or refused in one line."""

import gzip
import os
import resource
import subprocess
import sys

import numpy as np
import pytest
import trimesh
from corpus.damage import check_reader, reads
from mesh_files import TETRAHEDRON, TETRAHEDRON_FACES, WRITERS, ascii_ply

from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.rays.describe_rays import describe_rays
from neural_shadows.rays.draw_directions import draw_directions
from neural_shadows.rays.sample_rays import sample_rays

pytestmark = pytest.mark.filterwarnings("ignore")  # numpy's, of numbers out of range


BALL = trimesh.creation.icosphere(2)


def right():
    """Name, vertices and faces of odd meshes that must be read."""
    v, f = BALL.vertices, BALL.faces
    yield "some without area", v, np.vstack([f, f[:20, [0, 0, 1]], f[:20, [0, 1, 1]]])
    yield "needles", np.vstack([TETRAHEDRON[:3], [1e-5, 1e-5, 1e6]]), TETRAHEDRON_FACES
    yield "both sides, a hundred times", v, np.tile(np.vstack([f, f[:, ::-1]]), (100, 1))
    yield "soup", v[f].reshape(-1, 3), np.arange(f.size).reshape(-1, 3)
    yield "vertices of no face", np.vstack([v, v * 9]), f
    edge = np.vstack([TETRAHEDRON, [[-1, 0, 0]]])
    yield "three sheets at an edge", edge, np.array([[0, 3, 1], [0, 3, 2], [0, 3, 4]])
    second = np.where(TETRAHEDRON_FACES == 0, 0, TETRAHEDRON_FACES + 3)[:, ::-1]
    touching = np.vstack([TETRAHEDRON, -TETRAHEDRON[1:]])
    yield "two bodies at a vertex", touching, np.vstack([TETRAHEDRON_FACES, second])
    yield "a hemisphere", v, f[BALL.triangles_center[:, 2] > 0]
    yield "one triangle", TETRAHEDRON[:3], np.array([[0, 1, 2], [2, 1, 0]])
    yield "large", v * 1e30, f


def wrong():
    """Meshes that must be refused."""
    v, f = BALL.vertices, BALL.faces
    yield "a NaN", np.where(np.arange(len(v))[:, None] == 5, np.nan, v), f
    yield "near float64's limit", v * 1.7e308, f
    yield "on a line", np.outer(np.arange(len(v)), [1.0, 2, 3]), f


def read(path):
    out = path.parent / "out"
    prepare_mesh(path, out / "mesh.ply", out / "mesh.json", mesh={}, name="thing")
    mesh = read_prepared(out / "mesh.ply")
    assert 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.vertices)
    assert np.linalg.norm(mesh.vertices, axis=1).max() < 1 + 1e-4
    for normals in mesh.vertex_normals, mesh.face_normals:
        assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-5


def reads_as(tmp_path, file, content):
    (tmp_path / file).write_bytes(content)
    return reads(read, tmp_path / file)


@pytest.mark.parametrize("file", WRITERS)
def test_odd_shapes(tmp_path, file):
    for name, vertices, faces in right():
        assert reads_as(tmp_path, file, WRITERS[file](vertices, faces)), name
    for name, vertices, faces in wrong():
        assert not reads_as(tmp_path, file, WRITERS[file](vertices, faces)), name


@pytest.mark.parametrize("file", [*WRITERS, "source.ply.gz"])
def test_in_the_place_of_a_mesh(tmp_path, monkeypatch, file):
    monkeypatch.chdir(tmp_path)
    whole = WRITERS[file.removesuffix(".gz")](BALL.vertices, BALL.faces)
    whole = gzip.compress(whole) if file.endswith(".gz") else whole
    check_reader(read, tmp_path / file, whole)


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("ascii.ply", b"vertex 4", b"vertex 2147483648"),
        ("ascii.ply", b"property double z\n", b""),
        ("ascii.ply", b"3 1 2 3", b"3 one two three"),
        ("ascii.ply", b"0.0 1.0 0.0", b"0.0 1e999 0.0"),
        ("source.obj", b"f 1 2 4", b"f 1 2 1" + b"0" * 5000),
        ("source.glb", b'"count":4', b'"count":9'),
        ("source.glb", b'"bufferView":0', b'"bufferView":7'),
    ],
)
def test_something_else_in_a_header_or_a_row(tmp_path, file, old, new):
    whole = WRITERS[file](TETRAHEDRON, TETRAHEDRON_FACES)
    assert old in whole and reads_as(tmp_path, file, whole)
    assert not reads_as(tmp_path, file, whole.replace(old, new, 1))


PREPARE = """
import sys
from pathlib import Path
from neural_shadows.meshes.prepare_mesh import prepare_mesh
prepare_mesh(Path(sys.argv[1]), Path("m.ply"), Path("m.json"), mesh={}, name="large")
"""


@pytest.mark.parametrize("file", ["source.ply", "source.obj", "source.glb", "source.stl"])
def test_a_million_triangles(tmp_path, file):
    ball = trimesh.creation.icosphere(8)
    (tmp_path / file).write_bytes(WRITERS[file](ball.vertices, ball.faces))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", PREPARE, file]
    subprocess.run(command, env=environment, cwd=tmp_path, check=True, timeout=90)
    # Of all children, the one that took most.
    assert resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss < 4 * 2**20


@pytest.mark.parametrize(("vertices", "faces"), [pytest.param(v, f, id=n) for n, v, f in right()])
def test_odd_shapes_have_rays(tmp_path, vertices, faces):
    (tmp_path / "source.ply").write_bytes(ascii_ply(vertices, faces))
    mesh, directions, origins, bounds, rays = (
        tmp_path / name for name in ("m.ply", "d.npy", "o.npy", "b.npy", "rays.json")
    )
    prepare_mesh(tmp_path / "source.ply", mesh, tmp_path / "m.json", mesh={}, name="thing")
    sampling = {"sampler": "poisson_quadtree", "directions": 20, "points_per_direction": 100}
    sampling |= {"silhouette_resolution": 32, "min_quad": 1}
    made = {"mesh_ply": mesh, "directions_npy": directions, "seed": 3}
    part = {"origins_npy": origins, "bounds_npy": bounds, "first": 0, "last": 20}
    draw_directions(directions_npy=directions, sampling=sampling, seed=3)
    sample_rays(**made, **part, sampling=sampling)
    describe_rays(**made, origins=[origins], bounds=[bounds], rays_json=rays, sampling=sampling)
