"""Meshes as they are found: whatever is in the file, it is read rightly or refused in one line."""

import gzip
import os
import resource
import subprocess
import sys

import numpy as np
import pytest
from corpus.damage import changed_bytes, changed_numbers, reads, strangers
from corpus.odd_meshes import BALL, drawn, right, sheet, wrong
from hypothesis import given
from mesh_files import TETRAHEDRON, TETRAHEDRON_FACES, WRITERS, binary_ply, pack_glb

from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.rays.describe_rays import describe_rays
from neural_shadows.rays.draw_directions import draw_directions
from neural_shadows.rays.label_rays import label_rays
from neural_shadows.rays.sample_rays import sample_rays

pytestmark = pytest.mark.filterwarnings("ignore")  # numpy's, of numbers out of range


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
    for name, content in strangers().items():
        assert not reads_as(tmp_path, file, content), name
    whole = WRITERS[file.removesuffix(".gz")](BALL.vertices, BALL.faces)
    whole = gzip.compress(whole) if file.endswith(".gz") else whole
    for share in (0.1, 0.5, 0.9):  # a cut OBJ may be one of fewer faces
        cut = whole[: int(share * len(whole))]
        assert not reads_as(tmp_path, file, cut) or file.endswith("obj")
    assert {path.name for path in tmp_path.iterdir()} <= {file, "out"}


REPLACED = {
    "ascii.ply": [
        (b"vertex 4", b"vertex 2147483648"),
        (b"face 4", b"face 1" + b"0" * 100),
        (b"vertex 4", b"vertex -4"),
        (b"vertex 4", b"vertex 3"),
        (b"end_header\n", b""),
        (b"ascii 1.0", b"utf_16 1.0"),
        (b"double x", b"quad x"),
        (b"property double z\n", b""),
        (b"3 1 2 3", b"3 one two three"),
        (b"0.0 1.0 0.0", b"0,0 1,0 0,0"),
        (b"0.0 1.0 0.0", b"0.0 1e999 0.0"),
    ],
    "source.ply": [(b"vertex 4", b"vertex 9223372036854775808"), (b"list uchar", b"list uint")],
    "source.obj": [
        *((b"f 1 2 4", b"f " + face) for face in (b"-1 -2 -9", b"/ / /", b"1 2 1" + b"0" * 5000)),
        *((b"v 1.0 0.0 0.0", b"v " + row) for row in (b"a b c", b"1,5 2,5 3,5", b"1e999 0 0")),
    ],
    "ascii.stl": [(b"0.0 0.0 0.0", row) for row in (b"0.0 x 0.0", b"0.0 0.0", b"1e999 0.0 0.0")],
    "source.glb": [
        *((b'"count": 4', b'"count": ' + n) for n in (b"2147483648", b"-4", b"3.5", b'"4"')),
        (b'"type": "VEC3"', b'"type": "VEC2"'),
        (b'"bufferView": 0', b'"bufferView": 7'),
        (b'"byteOffset": 48', b'"byteOffset": 1000000000'),
        (b'"POSITION"', b'"OTHER"'),
        (b'"mesh": 0', b'"mesh": 3'),
        (b'"byteLength": 96', b'"uri": "file:///etc/passwd", "byteLength": 96'),
    ],
}


@pytest.mark.parametrize("file", REPLACED)
def test_something_else_in_a_header_or_a_row(tmp_path, file):
    whole = WRITERS[file](TETRAHEDRON, TETRAHEDRON_FACES)
    assert reads_as(tmp_path, file, whole)
    for old, new in REPLACED[file]:
        if file == "source.glb":
            end = 20 + int.from_bytes(whole[12:16], "little")
            changed = pack_glb(whole[20:end].replace(old, new), whole[end + 8 :])
        else:
            changed = whole.replace(old, new, 1)
        assert changed != whole
        assert not reads_as(tmp_path, file, changed), (old, new)


@pytest.mark.parametrize("file", WRITERS)
def test_drawn_damage(tmp_path, file):
    whole = WRITERS[file](BALL.vertices, BALL.faces)

    damaged = changed_bytes(whole) | drawn().map(lambda mesh: WRITERS[file](*mesh))
    if file in ("ascii.ply", "source.obj", "ascii.stl"):
        damaged |= changed_numbers(whole)

    @given(damaged)
    def check(content):
        reads_as(tmp_path, file, content)

    check()


PREPARE = """
import sys
from pathlib import Path
from neural_shadows.meshes.prepare_mesh import prepare_mesh
source = Path(sys.argv[1])
prepare_mesh(source, source.with_name("m.ply"), source.with_name("m.json"), mesh={}, name="large")
"""


@pytest.mark.parametrize("file", ["source.ply", "source.obj", "source.glb", "source.stl"])
def test_two_million_triangles(tmp_path, file):
    (tmp_path / file).write_bytes(WRITERS[file](*sheet(2_000_000)))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([sys.executable, "-c", PREPARE, tmp_path / file], env=environment, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)  # its memory is the largest child's
    assert after.ru_utime - before < 90 and after.ru_maxrss < 4 * 2**20


@pytest.mark.parametrize(("vertices", "faces"), [pytest.param(v, f, id=n) for n, v, f in right()])
def test_odd_shapes_have_rays(tmp_path, vertices, faces):
    (tmp_path / "source.ply").write_bytes(binary_ply(vertices, faces))
    mesh, directions, origins, bounds, rays = (
        tmp_path / name for name in ("m.ply", "d.npy", "o.npy", "b.npy", "rays.json")
    )
    prepare_mesh(tmp_path / "source.ply", mesh, tmp_path / "m.json", mesh={}, name="thing")
    sampling = {"sampler": "poisson_quadtree", "directions": 20, "points_per_direction": 100}
    sampling |= {"silhouette_resolution": 32, "min_quad": 1}
    made = {"mesh_ply": mesh, "directions_npy": directions, "seed": 3}
    part = {"origins_npy": origins, "first": 0, "last": 20}
    draw_directions(directions_npy=directions, sampling=sampling, seed=3)
    sample_rays(**made, **part, sampling=sampling)
    label_rays(**made, **part, bounds_npy=bounds)
    describe_rays(**made, origins=[origins], bounds=[bounds], rays_json=rays, sampling=sampling)
