import numpy as np
import pytest
from shapes import AXES, unit

from neural_shadows.rays.silhouette import entry_points, plane_basis, silhouette
from neural_shadows.scenes.tracing import Tracer

NEAR_POLES = [unit(1e-9, -1e-12, -1), unit(1e-4, 2e-5, -1), unit(1e-300, 0, -1), unit(1, 1, -1e-17)]


def test_basis_is_orthonormal_and_entry_points_project_to_their_offsets():
    rng = np.random.default_rng(0)
    angle, distance = rng.uniform(0, 2 * np.pi, 300), np.sqrt(rng.uniform(0, 1 - 1e-6, 300))
    offsets = distance[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for d in [*AXES, *NEAR_POLES, *(unit(*drawn) for drawn in rng.normal(size=(200, 3)))]:
        basis = np.stack([*plane_basis(d), d])
        assert np.abs(basis @ basis.T - np.eye(3)).max() < 1e-15 * 4
        assert np.abs(np.cross(basis[0], basis[1]) - d).max() < 1e-15 * 4  # right-handed
        o = entry_points(d, offsets)
        assert o.dtype == np.float32
        assert np.abs(np.linalg.norm(o.astype(float), axis=1) - 1).max() < 2e-7
        assert (o @ d < -9e-4).all()  # the side where rays along d come in
        assert np.abs(o @ basis[:2].T - offsets).max() < 2e-7


def rectangle_across(d, a, b):
    """A rectangle in the plane of d, over a[0] to a[1] along u, and b likewise."""
    u, v = plane_basis(d)
    corners = [a[i] * u + b[j] * v for i, j in [(0, 0), (1, 0), (1, 1), (0, 1)]]
    return Tracer(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]]))


@pytest.mark.parametrize("d", [unit(1, 2, 3), unit(0, 0, -1), unit(-1, 0.2, -0.4)])
def test_rows_are_b_and_columns_are_a(d):
    # Its edges are between texel centres: in 16 texels, columns 9 to 13 and rows 2 to 4.
    tracer = rectangle_across(d, a=(0.125, 0.75), b=(-0.75, -0.375))
    expected = np.zeros((16, 16), bool)
    expected[2:5, 9:14] = True
    assert np.array_equal(silhouette(tracer, d, 16), expected)


def test_texels_with_their_centre_outside_the_disk_are_empty():
    # A wall behind all rays covers every texel that is traced at all.
    d = unit(1, -2, 0.5)
    covered = silhouette(rectangle_across(d, a=(-2, 2), b=(-2, 2)), d, 64)
    rows, columns = np.mgrid[:64, :64]
    inside = np.hypot(2 * rows - 63, 2 * columns - 63) < 64
    assert np.array_equal(covered, inside)
    assert 0.75 < covered.mean() < 0.81  # π / 4
