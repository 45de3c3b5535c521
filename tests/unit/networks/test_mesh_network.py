"""The mesh as a network, against the tracer; its size."""

import itertools
import os
import subprocess
import sys

import DracoPy
import numpy as np
import pytest
import torch
import trimesh
from built_networks import laid_out, reloaded
from rays import ball_batch
from shapes import bumpy_sphere, prepared

from neural_shadows.errors import InputError
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.sphere_rays import sphere_rays
from neural_shadows.networks.weight_file import load_network, save_tensors
from neural_shadows.representations.depths import LIT
from neural_shadows.representations.meshes.coded_mesh import coded, decoded
from neural_shadows.representations.meshes.decimation import decimated, without_flaps
from neural_shadows.running.module_graph import PACKAGE


def build_network(shape: trimesh.Trimesh, tmp_path, triangles=None, bits=16, stored="packed"):
    settings = {"encoding": "mesh", "triangles": triangles, "bits": bits, "stored": stored}
    return reloaded(laid_out(shape, tmp_path, settings), tmp_path, settings)


def test_halves_of_flaps_do_not_hinder_decimation():
    """Triangles on an edge of a closed mesh go, those of a closed and of an open one stay."""
    closed = bumpy_sphere(3)
    count, faces = len(closed.vertices), closed.faces
    first, second = faces[7, :2]
    assert len(without_flaps(np.vstack([faces, [[first, second, count]]]))) == len(faces)
    assert np.array_equal(without_flaps(faces), faces)
    rim = faces[closed.triangles_center[:, 2] > 0]
    assert np.array_equal(without_flaps(rim), rim)


@pytest.mark.parametrize(
    ("triangles", "bits", "error"), [(None, 16, 1e-4), (None, 8, 0.02), (1500, 16, 0.02)]
)
def test_rays_end_where_the_mesh_is(tmp_path, triangles, bits, error):
    shape = bumpy_sphere(4)
    network = build_network(shape, tmp_path, triangles, bits)
    o, d, *_ = ball_batch(5000)
    t, face = prepared(shape)[1].first_hit(o.numpy(), d.numpy())
    result = network(o, d, torch.float32).numpy()
    both = (face >= 0) & (result < LIT)
    assert 0.5 < both.mean() < 1
    # Where a ray grazes a bump, one of them may miss it.
    assert ((face >= 0) == (result < LIT)).mean() > 0.97
    assert (np.abs(result - t)[both] < error).mean() > 0.97


@pytest.mark.parametrize("bias", [0.0, 0.03, -0.02])
def test_occlusion_rays_equal_the_depth_test(tmp_path, bias):
    """`lit` by a ray towards the light against `ShadowNetwork.lit` by the first hit's depth."""
    network = build_network(bumpy_sphere(4), tmp_path)
    light = torch.nn.functional.normalize(torch.tensor([0.3, 1.0, -0.5]), dim=0)
    p = torch.randn(20_000, 3, generator=torch.Generator().manual_seed(0))
    rays = sphere_rays(p, light)
    result, expected = (
        target(rays, -light, torch.float32)(bias)
        for target in (network.lit, lambda *of: ShadowNetwork.lit(network, *of))
    )
    assert 0.1 < expected.float().mean() < 0.9
    # Edges of triangles and the sphere's rim, where either may be right.
    assert (result == expected).float().mean() > 0.999


def test_bytes(tmp_path):
    """Of an icosphere of 642 vertices and 1,280 faces."""
    network = build_network(trimesh.creation.icosphere(3), tmp_path, bits=14)
    stored = {name: tensor.nbytes for name, tensor in network.stored().items()}
    # ⌈log₂ 642⌉ = 10 bits an index.
    assert stored == {"counts": 8, "vertices": -(-642 * 3 * 14 // 8), "faces": 1280 * 3 * 10 // 8}


def corners_of(steps, faces) -> set[tuple]:
    """The triangles as triples of places, each from its least corner on: its winding is kept."""
    turned = (np.roll(corners, -shift, axis=1) for corners in [steps[faces]] for shift in range(3))
    keys = np.stack([each.reshape(len(faces), 9) for each in turned], axis=1).tolist()
    return {min(map(tuple, three)) for three in keys}


@pytest.mark.parametrize(
    ("triangles", "bits"), [(None, 4), (None, 8), (700, 12), (1500, 16), (None, 21), (None, 23)]
)
def test_a_coded_mesh_is_the_quantised_one_exactly(tmp_path, triangles, bits):
    """The same triangles between the same places, in fewer bytes; only their order is another."""
    result, expected = (
        build_network(bumpy_sphere(4), tmp_path, triangles, bits, stored)
        for stored in ("coded", "packed")
    )
    assert corners_of(result._steps, result._faces) == corners_of(expected._steps, expected._faces)
    assert len(result._faces) == len(expected._faces)
    assert sorted(result._steps.tolist()) == sorted(expected._steps.tolist())
    sizes = [
        sum(parameter.nbytes for parameter in network.stored().values())
        for network in (result, expected)
    ]
    assert 1.9 * sizes[0] < sizes[1]
    rays = ball_batch(2000)[:2]
    depths = [network(*rays, torch.float32) for network in (result, expected)]
    assert (torch.isclose(*depths, atol=1e-6) | (depths[0] == depths[1])).float().mean() > 0.999


def test_an_edge_of_many_triangles_is_coded_exactly():
    """All triangles between eight points: Draco keeps a vertex for each fan."""
    steps = np.random.default_rng(1).permutation(4096)[:24].reshape(8, 3)
    faces = np.array(list(itertools.combinations(range(8), 3)))
    assert corners_of(*decoded(coded(steps, faces, 12))) == corners_of(steps, faces)


def test_damaged_coded_meshes_are_refused(tmp_path):
    network = build_network(bumpy_sphere(2), tmp_path, stored="coded")
    whole = network.stored()["mesh"]
    points = bytearray(DracoPy.encode(np.eye(3, dtype=np.float32)))
    path = tmp_path / "weights.safetensors"
    for mesh, bits, reason in (
        *((wrong, 16, "") for wrong in (whole[:0], whole[:-3], torch.zeros(100).byte())),
        (torch.frombuffer(points, dtype=torch.uint8), 16, "points without faces"),
        (whole, 12, "vertices beyond 12 bits"),
    ):
        settings = {"encoding": "mesh", "triangles": None, "bits": bits, "stored": "coded"}
        save_tensors(path, {"mesh": mesh}, {"network": settings})
        with pytest.raises(InputError, match=f"do not fit the header .{reason}.* Delete it and tr"):
            load_network(path)


MEASURE = """
import ctypes, sys
import numpy as np
from neural_shadows.scenes.tracing import Tracer

def held():
    with open("/proc/self/status") as status:
        return next(1024 * int(line.split()[1]) for line in status if line.startswith("VmRSS:"))

vertices, faces = (np.load(path) for path in sys.argv[1:])
Tracer(vertices[:3], np.array([[0, 1, 2]], np.int32))
give_back = ctypes.CDLL(None).malloc_trim
give_back(0)
before = held()
tracers = [Tracer(vertices, faces) for _ in range(4)]
give_back(0)
print((held() - before) / 4)
"""


def test_resident_bytes_are_embrees_memory(tmp_path):
    shape = trimesh.creation.icosphere(5)
    network = build_network(shape, tmp_path)
    np.save(tmp_path / "vertices.npy", shape.vertices.astype(np.float32))
    np.save(tmp_path / "faces.npy", shape.faces.astype(np.int32))
    command = [sys.executable, "-c", MEASURE, tmp_path / "vertices.npy", tmp_path / "faces.npy"]
    environment = os.environ | {"PYTHONPATH": str(PACKAGE.parent)}
    out = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    assert float(out.stdout) == pytest.approx(network.resident_bytes(), rel=0.15)


@pytest.mark.parametrize("triangles", [4, 200, 1279, 1280, 5000])
def test_decimation_reaches_the_number_of_triangles(triangles):
    shape = trimesh.creation.icosphere(3)
    vertices, faces = decimated(shape.vertices, shape.faces, triangles)
    target = min(triangles, 1280)
    assert target - 2 <= len(faces) <= target
    radii = np.linalg.norm(vertices[faces], axis=2)
    # A regular polyhedron of so many faces has at least this edge.
    assert np.abs(radii - 1).max() < 8 / target


def test_a_stuck_decimation_prints_a_line(capsys):
    """All triangles between eight points: each edge is of six."""
    corners = np.random.default_rng(1).uniform(-1, 1, (8, 3))
    faces = np.array(list(itertools.combinations(range(8), 3)), np.int32)
    _, left = decimated(corners, faces, 4)
    assert f"to 4 triangles ends at {len(left)}:" in capsys.readouterr().out


def test_an_empty_decimation_is_refused():
    """Twelve triangles round one edge."""
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    rim = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    faces = np.stack([np.zeros(12), np.ones(12), np.arange(2, 14)], axis=1).astype(np.int32)
    with pytest.raises(InputError, match="triangles: 4: the decimated mesh has none left"):
        decimated(np.concatenate([[[0, 0, 0], [0, 0, 1]], rim]), faces, 4)


def test_faces_beyond_the_vertices_are_refused(tmp_path):
    network = build_network(trimesh.creation.icosphere(1), tmp_path)
    tensors = network.stored()
    tensors["faces"].fill_(255)
    with pytest.raises(ValueError, match="vertices beyond its 42"):
        network.restore(tensors)
    with pytest.raises(ValueError, match="packed bits"):
        network.restore(network.stored() | {"counts": torch.tensor([42, 81])})
