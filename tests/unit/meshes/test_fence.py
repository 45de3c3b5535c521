"""The fence: closed parts, woven without touching, as open as its pattern says."""

import numpy as np
import pytest
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.meshes.fence import BAR_RADII, HEIGHT, WEAVE, make_fence
from neural_shadows.scenes.tracing import Tracer

WIRES, RADIUS = 8, 0.01


@pytest.fixture(scope="module")
def fence():
    return trimesh.Trimesh(*make_fence(wires=WIRES, wire_radius=RADIUS), process=False)


@pytest.fixture(scope="module")
def tracer(fence):
    return Tracer(fence.vertices.astype(np.float32), fence.faces)


def depths(tracer, x, y):
    """Places along z of the first surface seen from the front and from the back at (x, y)."""
    x, y = np.broadcast_arrays(x, y)
    points = np.stack([x, y, np.ones(np.shape(x))], axis=-1).reshape(-1, 3).astype(np.float32)
    ahead = np.tile(np.float32([0, 0, -1]), (len(points), 1))
    front = 1 - tracer.first_hit(points, ahead)[0]
    back = -1 + tracer.first_hit(points * np.float32([1, 1, -1]), -ahead)[0]
    return front, back


def test_every_part_is_closed_and_turned_outwards(fence):
    parts = fence.split(only_watertight=False)
    assert len(parts) > 4 + 2 * WIRES
    for part in parts:
        assert part.is_watertight and part.is_winding_consistent
        assert part.volume > 0
    assert fence.area_faces.min() > 0
    bar = BAR_RADII * RADIUS
    assert fence.bounds[0] == pytest.approx([-bar, 0, -bar], abs=1e-3)
    assert fence.bounds[1] == pytest.approx([1 + bar, HEIGHT + 2 * bar, bar], abs=1e-3)


def test_wires_go_over_and_under_in_turn_and_leave_a_gap(tracer):
    pitch = 1 / WIRES
    i, j = np.meshgrid(np.arange(WIRES), np.arange(WIRES), indexing="ij")
    x, y = (i + j) * pitch / 2, (j - i) * pitch / 2
    inside = (x > pitch) & (x < 1 - pitch) & (y > pitch) & (y < HEIGHT - pitch)
    x, y, even = x[inside], y[inside] + BAR_RADII * RADIUS, ((i + j) % 2 == 0)[inside]
    assert len(x) > 8 and 0 < even.sum() < len(x)
    front, back = depths(tracer, x, y)
    # Two wires lie behind each other, 2 WEAVE radii between their centres: no overlap.
    thick = front - back
    assert thick == pytest.approx(np.full(len(x), 2 * (WEAVE + 1) * RADIUS), rel=0.02)
    # Half a diamond along the rising wire, the crossing one is gone: the front one is in front.
    step = 2 * RADIUS
    rising, _ = depths(tracer, x + step, y + step)
    falling, _ = depths(tracer, x + step, y - step)
    assert ((rising > falling) == even).all()


def test_the_open_share_is_the_pattern_s(tracer):
    rng = np.random.default_rng(0)
    points = rng.uniform([0.1, 0.15], [0.9, 0.7], (40_000, 2))
    front, _ = depths(tracer, points[:, 0], points[:, 1])
    covered = np.isfinite(front).mean()
    one = 2 * RADIUS * np.sqrt(2) * WIRES  # share that one family covers
    assert covered == pytest.approx(1 - (1 - one) ** 2, abs=0.02)


def test_wires_that_leave_no_hole_are_refused():
    with pytest.raises(InputError, match="wire_radius = 0.03"):
        make_fence(wires=16, wire_radius=0.03)
