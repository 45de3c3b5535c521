"""What the benchmarks print is right; how fast anything is they measure and no test asserts."""

import shutil
from itertools import islice
from types import SimpleNamespace

import bench_field
import embree_rays
import numpy as np
import pytest
import trimesh
from detailed_mesh import detailed_meshes
from measurement import COLUMNS, Row, median_seconds, table

from neural_shadows.errors import InputError
from neural_shadows.scenes.tracing import EmbreeSingly


def test_shares_and_ratios():
    rows = table(
        [
            Row("labels", "cpu", 3.0, "samples/s", ceiling=4.0, peer="trimesh", peer_rate=0.5),
            Row("rays", "cpu", 2.0, "samples/s"),
        ]
    )
    assert list(rows) == COLUMNS
    assert rows.iloc[0][["share", "ratio"]].tolist() == [0.75, 6.0]
    assert rows.iloc[1][["ceiling", "share", "peer", "ratio"]].isna().all()


def test_works_are_done_in_turn_and_the_first_round_does_not_count(monkeypatch):
    clock, done = [0.0], []
    monkeypatch.setattr("measurement.time.perf_counter", lambda: clock[0])
    seconds = {"a": iter([9, 1, 2, 6]), "b": iter([9, 4, 3, 5])}

    def work(name):
        done.append(name)
        clock[0] += next(seconds[name])

    found = median_seconds({"a": lambda: work("a"), "b": lambda: work("b")}, 3)
    assert done == ["a", "b"] * 4
    assert found == {"a": pytest.approx(2), "b": pytest.approx(4)}


@pytest.mark.parametrize(
    ("ratios", "said"),
    [
        ([0.5, 2.0, 3.0], "field as fast from 10,000 triangles on; ratio at 1,000,000"),
        ([1.5, 2.0, 3.0], "field as fast from fewer than 1,000 triangles on; ratio at 1,000,000"),
        ([1.5, 0.5, 0.9], "field not as fast at 1,000,000 triangles; ratio there"),
    ],
)
def test_from_how_many_triangles_on_a_field_is_faster(ratios, said):
    counts = np.array([1_000, 100_000, 1_000_000])
    assert bench_field.crossing(counts, np.array(ratios)) == said


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc builds embree_rays.c")
@pytest.mark.parametrize("count", [0, 1, 8, 13, 1003])
@pytest.mark.parametrize("end", [np.inf, 1 - 1e-4])
def test_rays_from_c_meet_what_those_of_embreex_meet(count, end):
    """Packets that are not full, one way for all, and ways that end before anything."""
    sphere = trimesh.creation.icosphere(3)
    embreex = EmbreeSingly(sphere.vertices, sphere.faces)
    scene = embree_rays.EmbreeTriangles(sphere.vertices, sphere.faces, robust=True)
    rng = np.random.default_rng(count)
    points = rng.uniform(-3, 3, (count, 3)).astype(np.float32)
    ways = rng.uniform(-3, 3, (count, 3)).astype(np.float32)
    for directions in (ways, np.float32([1, 3, 0.7])):
        along = np.ascontiguousarray(np.broadcast_to(directions, points.shape))
        expected = embreex.occluded(points, along, end) if count else np.zeros(0, bool)
        if count > 1000:
            assert 0.05 < expected.mean() < 0.95
        rays = points, directions, end
        forms = {"single": lambda rays=rays: scene.single(*rays), **scene.packet_forms(*rays)}
        assert len(forms) == 5
        for name, work in forms.items():
            assert np.array_equal(work(), expected), name
    assert scene.bytes > sphere.vertices.size * 4 + sphere.faces.size * 4
    scene.close()


def test_without_gcc_or_the_library_it_says_what_to_do(monkeypatch, tmp_path):
    with monkeypatch.context() as patch:
        patch.setattr(embree_rays.shutil, "which", lambda name: None)
        with pytest.raises(InputError, match="gcc: not found.*Install it"):
            embree_rays._compiled.__wrapped__()
    monkeypatch.setattr(embree_rays.embreex, "__file__", str(tmp_path / "embreex/__init__.py"))
    with pytest.raises(InputError, match="0 files embreex.libs/libembree4.*Install embreex"):
        embree_rays.embree.__wrapped__()


def test_the_better_form_of_packets_counts():
    seconds = {
        "embreex": 3.0,
        "p8": 2.0,
        "p8, not coherent": 1.0,
        "p16": 1.5,
        "p16, not coherent": 4,
    }
    assert embree_rays.best_of_forms(seconds) == {"embreex": 3.0, "p8": 1.0, "p16": 1.5}


def test_detail_is_a_cell_high_and_the_surface_stays_closed():
    sphere, cell = trimesh.creation.icosphere(4), 2 / 64
    meshes = detailed_meshes(sphere.vertices, sphere.faces, sphere.vertices, cell, 100_000)
    meshes = list(islice(meshes, 3))
    assert [len(faces) for _, faces in meshes] == [20_480, 81_920, 99_998]
    for vertices, faces in meshes[:2]:
        assert trimesh.Trimesh(vertices, faces, process=False).is_watertight
        away = np.linalg.norm(vertices, axis=1)
        assert away.max() <= 1
        assert 0.7 < away.std() / cell < 1.3


def test_the_smallest_mesh_of_an_error(monkeypatch):
    """Of meshes that differ in 1000 / triangles of a frame's answers."""

    class Mesh:
        vertices = None

        def __init__(self, vertices, faces):
            self.faces, self.count = faces, len(faces)
            self.scene = SimpleNamespace(close=lambda: None)

        def occluded(self, frame):
            return np.arange(10_000) < (1e7 / self.count if self.count < 100_000 else 0)

    monkeypatch.setattr(bench_field, "Triangles", Mesh)
    monkeypatch.setattr(
        bench_field, "decimated", lambda vertices, faces, count: (None, range(count))
    )
    frames = [SimpleNamespace(pixels=20_000)] * 2
    best, share, tried = bench_field.smallest_within(2.5, Mesh(None, range(100_000)), frames)
    assert 20_000 <= best.count <= 20_000 / (1 - bench_field.NEAR)
    assert share == tried[best.count] <= 2.5
    assert min(tried) < 20_000
