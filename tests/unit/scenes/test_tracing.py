"""Ways of a given length, as lights at a place need them; packets of rays beside embreex's own."""

import ctypes
import gc
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import trimesh
from shapes import box, bumpy_sphere, octahedron, prepared, sheet

from neural_shadows.scenes import embree_packets, tracing
from neural_shadows.scenes.embree_packets import LIBRARY, EmbreePackets
from neural_shadows.scenes.tracing import NEARLY_ALL, EmbreeSingly, Tracer

needs_library = pytest.mark.skipif(LIBRARY is None, reason="no Embree beside embreex here")
MESHES = {
    "box": box(1, 1, 1),
    "octahedron": octahedron(),
    "sheet": sheet(0.0, 1.0),
    "bumps": bumpy_sphere(5),
    "boxes": trimesh.util.concatenate(
        [box(0.2, 0.2, 0.2).apply_translation(at) for at in np.mgrid[-1:1:5j, -1:1:5j, 0:1:2j].T.reshape(-1, 3)]
    ),
}  # fmt: skip


def test_what_lies_behind_the_goal_blocks_nothing():
    """embreex takes a ray's length in units of its direction; held to the pinned version."""
    _, tracer = prepared(sheet(0.0, 1.0))
    points = np.array([[0, 2, 0]] * 4, np.float32)
    ways = np.array([[0, -1.9, 0], [0, -2.1, 0], [0, -2, 0], [0, 1, 0]], np.float32)
    # The third ends on the sheet itself.
    assert tracer.blocked(points, ways).tolist() == [False, True, False, False]


@needs_library
def test_rays_of_any_type_are_compiled_once():
    """Read-only, broadcast, of 64 bits and in columns: each cost 2 s of compiling more."""
    _, tracer = prepared(box(1, 1, 1))
    rays = np.ones((8, 3), np.float32)
    fixed = rays.copy()
    fixed.flags.writeable = False
    for origins in (rays, fixed, rays.astype(np.float64), np.asfortranarray(rays)):
        for directions in (rays, fixed, np.float32([0, 1, 0])):
            tracer._rays.occluded(origins, directions)
            tracer._rays.first_hit(origins, directions)
    for kernel in (embree_packets._fill_occluded, embree_packets._fill_hits):
        assert len(kernel.signatures) == 1


@pytest.mark.skipif(sys.platform != "linux", reason="other wheels may not hold the library")
def test_the_library_is_found():
    assert LIBRARY is not None and isinstance(prepared(box(1, 1, 1))[1]._rays, EmbreePackets)


def both(name: str) -> tuple[EmbreePackets, EmbreeSingly]:
    mesh, _ = prepared(MESHES[name])
    return EmbreePackets(mesh.vertices, mesh.faces), EmbreeSingly(mesh.vertices, mesh.faces)


def ray_sets(count: int) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Points and ways: anyhow, to a small light, as a grid that meets edges, with odd numbers."""
    rng = np.random.default_rng(count)
    points = rng.uniform(-2, 2, (count, 3))
    to_light = np.repeat(points[::8], 8, axis=0)[:count]
    disc = [0.3, 2.5, 0.4] - to_light + rng.normal(scale=0.05, size=to_light.shape)
    row, column = np.divmod(np.arange(count) % 33**2, 33)
    grid = np.stack([row / 16 - 1, column / 16 - 1, np.full(count, 2)], axis=1)
    odd = rng.choice([0, 1e-30, 1e30, np.inf, -np.inf, np.nan], (count, 3))
    ways = rng.uniform(-1, 1, (count, 3)) - points
    sets = {
        "anyhow": (points, ways),
        "to a light": (to_light, disc),
        "on edges": (grid, np.tile([0.0, 0.0, -1.0], (count, 1))),
        "odd ways": (points, np.where(rng.random((count, 3)) < 0.05, odd, ways)),
        "odd points": (np.where(rng.random((count, 3)) < 0.05, odd, to_light), disc),
    }
    return {name: tuple(np.float32(rows) for rows in rays) for name, rays in sets.items()}


@needs_library
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("count", [0, 1, 7, 8, 9, 20_003])
def test_packets_have_the_answers_of_single_rays(name, count):
    packets, singly = both(name)
    for rays, (points, ways) in ray_sets(count).items():
        for end in ({}, {"end": NEARLY_ALL}):
            expected = singly.occluded(points, ways, **end)
            assert np.array_equal(packets.occluded(points, ways, **end), expected), rays
            assert count < 100 or rays == "on edges" or 0 < expected.mean() < 1
        (t, face, u, v), (tc, fc, uc, vc) = (
            one.first_hit(points, ways) for one in (packets, singly)
        )
        hit = fc >= 0
        # Of neighbouring rays, one that grazes a triangle may meet or miss it, and one that meets an edge either
        # of its triangles.
        assert (~np.isclose(t, tc, rtol=1e-6, equal_nan=True)).sum() <= count / 10_000, rays
        same = hit & (face == fc)
        assert np.array_equal(u[same], uc[same]) and np.array_equal(v[same], vc[same]), rays
        if rays == "anyhow":
            assert np.array_equal(face, fc) and np.array_equal(t, tc), rays


@needs_library
def test_arrays_of_other_layouts():
    packets, singly = both("bumps")
    points, ways = ray_sets(1001)["anyhow"]
    expected = singly.occluded(points, ways)
    wide = np.zeros((1001, 5), np.float32)
    wide[:, 1:4] = points
    readonly = ways.copy()
    readonly.flags.writeable = False
    assert np.array_equal(packets.occluded(wide[:, 1:4], np.asfortranarray(readonly)), expected)
    same = packets.occluded(points, np.tile(ways[:1], (1001, 1)))
    assert np.array_equal(packets.occluded(points, ways[:1]), same)
    with pytest.raises(ValueError, match="broadcast"):
        packets.occluded(points, ways[:-1])


@needs_library
def test_threads_share_a_tree():
    packets, _ = both("bumps")
    points, ways = ray_sets(20_003)["to a light"]
    expected, hits = packets.occluded(points, ways), packets.first_hit(points, ways)
    with ThreadPoolExecutor(8) as pool:
        found = [pool.submit(packets.occluded, points, ways) for _ in range(40)]
        first = [pool.submit(packets.first_hit, points, ways) for _ in range(40)]
    assert all(np.array_equal(one.result(), expected) for one in found)
    assert all(np.array_equal(one.result()[0], hits[0]) for one in first)


@needs_library
def test_a_tree_is_freed_with_its_tracer():
    held = [0]

    @ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_ssize_t, ctypes.c_bool)
    def count(_, size, after):
        held[0] += size
        return True

    device = embree_packets._device()
    monitor = LIBRARY.rtcSetDeviceMemoryMonitorFunction
    monitor.argtypes = [ctypes.c_size_t, ctypes.c_void_p, ctypes.c_void_p]
    monitor(device, ctypes.cast(count, ctypes.c_void_p), None)
    try:
        mesh, _ = prepared(MESHES["bumps"])
        gc.collect()
        before = held[0]
        tracer = Tracer(mesh.vertices, mesh.faces)
        assert held[0] - before > 50 * len(mesh.faces)
        del tracer
        gc.collect()
        assert held[0] == before
    finally:
        monitor(device, None, None)


@needs_library
def test_what_embree_says_is_raised():
    LIBRARY.rtcNewGeometry(embree_packets._device(), 999)
    with pytest.raises(RuntimeError, match="^Embree: error 1: invalid geometry type$"):
        embree_packets._check(embree_packets._device())


def test_without_the_library_rays_go_singly(monkeypatch):
    mesh, tracer = prepared(MESHES["bumps"])
    monkeypatch.setattr(tracing, "LIBRARY", None)
    singly = Tracer(mesh.vertices, mesh.faces)
    assert isinstance(singly._rays, EmbreeSingly)
    points, ways = ray_sets(1001)["anyhow"]
    assert np.array_equal(singly.blocked(points, ways), tracer.blocked(points, ways))
    assert np.array_equal(singly.occluded(points, ways), tracer.occluded(points, ways))
    for ours, other in zip(singly.first_hit(points, ways), tracer.first_hit(points, ways)):
        assert np.array_equal(ours, other)


def test_a_wheel_without_the_library(monkeypatch):
    class Wheel:
        files = None

    monkeypatch.setattr(embree_packets, "distribution", lambda name: Wheel)
    assert embree_packets._library() is None
