"""The procedural meshes against what is asked of them, and which of them are sheets."""

import numpy as np
import pytest
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.meshes.fence import BAR_RADII, HEIGHT, WEAVE, make_fence
from neural_shadows.meshes.landscape import make_landscape
from neural_shadows.meshes.open_sides import is_sheet
from neural_shadows.meshes.signed_distances import Part, distance_grid
from neural_shadows.meshes.wyrm import cones, ellipsoid, make_wyrm
from neural_shadows.scenes.tracing import Tracer

CELLS, WIRES, RADIUS = 128, 8, 0.01


def test_the_wyrm_is_closed_in_one_piece_and_stands_on_its_feet():
    wyrm = trimesh.Trimesh(*make_wyrm(), process=False)
    assert 230_000 <= len(wyrm.faces) <= 250_000
    # PLY files hold float32: no two vertices may fall together there.
    rounded = trimesh.Trimesh(wyrm.vertices.astype(np.float32), wyrm.faces, process=True)
    assert rounded.is_watertight and rounded.is_winding_consistent and rounded.volume > 0.1
    assert rounded.body_count == 1 and len(rounded.vertices) == len(wyrm.vertices)
    assert rounded.nondegenerate_faces().all()
    assert wyrm.bounds[0, 1] == 0
    for x, z in [(-0.33, 0.24), (-0.21, -0.24), (0.39, 0.23), (0.23, -0.23)]:
        under = np.hypot(wyrm.vertices[:, 0] - x, wyrm.vertices[:, 2] - z) < 0.2
        assert wyrm.vertices[under, 1].min() < 0.01 * wyrm.scale


def test_signed_distances_near_the_surface():
    corners = np.array([[0.0, 0, 0], [2, 0.3, 0], [0.5, 1, 0.7]])
    for part, flat, radius in [
        (cones(np.array([[0, 0, 0, 0.3], [2, 0, 0, 0.3]]), 0.01), [[0, 0, 0], [2, 0, 0]] * 2, 0.3),
        (Part(np.c_[corners, [0.2, 0.2, 0.2]][None], 0.01), corners, 0.2),
        (ellipsoid((0, 0, 0), (0.5, 0.5, 0.5), 0.01), np.zeros((3, 3)), 0.5),
    ]:
        grid, origin, cell = distance_grid([part], 60)
        points = origin + cell * np.stack(np.indices(grid.shape), axis=-1).reshape(-1, 3)
        triangles = np.broadcast_to(flat[:3], (len(points), 3, 3))
        nearest = trimesh.triangles.closest_point(triangles, points)
        exact = np.linalg.norm(points - nearest, axis=1).reshape(grid.shape) - radius
        near = np.abs(exact) < 2 * cell
        assert near.sum() > 1000
        np.testing.assert_allclose(grid[near], exact[near], atol=1e-5)


def test_the_landscape_is_one_open_sheet_of_low_frequency():
    landscape = trimesh.Trimesh(*make_landscape(cells=CELLS), process=False)
    assert len(landscape.faces) == 2 * CELLS**2 and landscape.body_count == 1
    edges, count = np.unique(np.sort(landscape.edges, axis=1), axis=0, return_counts=True)
    assert set(count) == {1, 2}
    assert (count == 1).sum() == 4 * CELLS  # one boundary, the square's
    assert (landscape.face_normals[:, 1] > 0).all()  # no overhang, seen from above
    assert landscape.bounds[:, [0, 2]] == pytest.approx(np.array([[-1, -1], [1, 1]]))
    height = landscape.vertices[:, 1].reshape(CELLS + 1, -1)[:-1, :-1]
    window = np.hanning(CELLS)
    power = np.abs(np.fft.fft2((height - height.mean()) * np.outer(window, window))) ** 2
    frequency = np.hypot(*np.meshgrid(*[np.fft.fftfreq(CELLS, 1 / CELLS)] * 2))
    assert power[frequency <= 8].sum() > 0.9 * power.sum()


def test_every_part_of_the_fence_is_closed():
    fence = trimesh.Trimesh(*make_fence(wires=WIRES, wire_radius=RADIUS), process=False)
    parts = fence.split(only_watertight=False)
    assert len(parts) > 4 + 2 * WIRES
    assert all(p.is_watertight and p.is_winding_consistent and p.volume > 0 for p in parts)
    bar = BAR_RADII * RADIUS
    assert fence.bounds[0] == pytest.approx([-bar, 0, -bar], abs=1e-3)
    assert fence.bounds[1] == pytest.approx([1 + bar, HEIGHT + 2 * bar, bar], abs=1e-3)
    with pytest.raises(InputError, match="wire_radius = 0.03"):
        make_fence(wires=16, wire_radius=0.03)


def test_wires_are_woven_and_as_open_as_their_pattern():
    vertices, faces = make_fence(wires=WIRES, wire_radius=RADIUS)
    tracer = Tracer(vertices.astype(np.float32), faces)

    def depths(x, y):
        """Places along z of the first surface seen from the front and from the back."""
        points = np.stack([x, y, np.ones(len(x))], axis=-1).astype(np.float32)
        ahead = np.tile(np.float32([0, 0, -1]), (len(x), 1))
        front = 1 - tracer.first_hit(points, ahead)[0]
        return front, tracer.first_hit(points * np.float32([1, 1, -1]), -ahead)[0] - 1

    pitch, step = 1 / WIRES, 2 * RADIUS
    i, j = np.indices((WIRES, WIRES))
    x, y = (i + j) * pitch / 2, (j - i) * pitch / 2
    inside = (x > pitch) & (x < 1 - pitch) & (y > pitch) & (y < HEIGHT - pitch)
    x, y, even = x[inside], y[inside] + BAR_RADII * RADIUS, ((i + j) % 2 == 0)[inside]
    front, back = depths(x, y)
    # Two wires lie behind each other, 2 WEAVE radii between their centres: no overlap.
    assert front - back == pytest.approx(np.full(len(x), 2 * (WEAVE + 1) * RADIUS), rel=0.02)
    # Half a diamond along the rising wire, the crossing one is gone: the front one is in front.
    rising, falling = depths(x + step, y + step)[0], depths(x + step, y - step)[0]
    assert ((rising > falling) == even).all() and 0 < even.sum() < len(x)

    points = np.random.default_rng(0).uniform([0.1, 0.15], [0.9, 0.7], (40_000, 2))
    covered = np.isfinite(depths(*points.T)[0]).mean()
    one = 2 * RADIUS * np.sqrt(2) * WIRES  # share that one family covers
    assert covered == pytest.approx(1 - (1 - one) ** 2, abs=0.02)


BALL, BOX = trimesh.creation.icosphere(4), trimesh.creation.box(extents=[1, 1, 1])


@pytest.mark.parametrize(
    ("vertices", "faces", "expected"),
    [
        (*make_landscape(cells=64), True),
        (BALL.vertices, BALL.faces[BALL.triangles_center[:, 2] > 0], True),
        (BOX.vertices, BOX.faces[BOX.face_normals[:, 2] < 0.5], True),  # no lid
        (BALL.vertices, BALL.faces[BALL.triangles_center[:, 2] > -0.95], False),  # a hole
    ],
)
def test_sheets(vertices, faces, expected):
    mixed = faces.copy()
    mixed[::2] = mixed[::2, ::-1]
    for wound in (faces, faces[:, ::-1], mixed):
        assert is_sheet(vertices, wound) == expected
