"""The z-buffer beside a test of each texel by each triangle."""

import numpy as np
import pytest

from neural_shadows.shadow_maps.z_buffer import drawn

SIZE = 48


def one_by_one(x, y, z, faces):
    rows, columns = np.mgrid[:SIZE, :SIZE].astype(float)
    heights = np.full((SIZE, SIZE), -np.inf)
    for face in faces:
        (ax, bx, cx), (ay, by, cy), corners = x[face], y[face], z[face]
        a = (bx - columns) * (cy - rows) - (by - rows) * (cx - columns)
        b = (cx - columns) * (ay - rows) - (cy - rows) * (ax - columns)
        c = (ax - columns) * (by - rows) - (ay - rows) * (bx - columns)
        areas = np.stack([a, b, c])
        areas = areas if areas.sum() > 0 else -areas
        inside = (areas >= 0).all(0) & (areas.sum(0) > 0)
        with np.errstate(invalid="ignore", divide="ignore"):
            height = np.tensordot(corners, areas, 1) / areas.sum(0)
        heights = np.where(inside, np.maximum(heights, height), heights)
    return heights


@pytest.mark.parametrize("spread", [1.0, 12.0, 300.0, 1e6])  # texels: the last, cut by a near plane
def test_triangles_of_any_size(spread):
    rng = np.random.default_rng(7)
    middle = rng.uniform(0, SIZE, (60, 1, 2))
    x, y = (middle + rng.normal(0, spread, (60, 3, 2))).reshape(-1, 2).T
    z = rng.uniform(1, 2, len(x))
    faces = np.arange(len(x), dtype=np.int32).reshape(-1, 3)
    found, expected = drawn(x, y, z, faces, SIZE), one_by_one(x, y, z, faces)
    assert np.array_equal(np.isfinite(found), np.isfinite(expected))
    seen = np.isfinite(expected)
    assert 30 < seen.sum() and np.abs(found[seen] - expected[seen]).max() < 1e-6


def test_nothing_is_seen_between_triangles():
    """A fan round a texel's centre, its edges through many others."""
    turn = np.arange(24) * np.pi / 12
    x, y = (np.append(20 + 100 * axis(turn), 20.0) for axis in (np.cos, np.sin))
    edge = np.arange(24, dtype=np.int32)
    faces = np.stack([np.full(24, 24, np.int32), edge, (edge + 1) % 24], axis=1)
    assert np.isfinite(drawn(x, y, np.ones(25), faces, SIZE)).all()
