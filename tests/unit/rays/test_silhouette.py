import numpy as np
import pytest
from shapes import AXES, unit

from neural_shadows.rays.silhouette import entry_points, plane_basis, silhouette
from neural_shadows.scenes.tracing import Tracer


@pytest.mark.parametrize("d", [*AXES, unit(1e-9, -1e-12, -1), unit(1, 1, -1e-17), unit(1, 2, 3)])
def test_basis_is_orthonormal_and_entry_points_project_to_their_offsets(d):
    angle = np.linspace(0, 7, 300)
    offsets = np.linspace(0, 0.9999, 300)[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
    basis = np.stack([*plane_basis(d), d])
    assert np.abs(basis @ basis.T - np.eye(3)).max() < 4e-15
    assert np.abs(np.cross(basis[0], basis[1]) - d).max() < 4e-15  # right-handed
    o = entry_points(d, offsets)
    assert np.abs(np.linalg.norm(o.astype(float), axis=1) - 1).max() < 2e-7
    assert (o @ d < 0).all()  # the side where rays along d come in
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
