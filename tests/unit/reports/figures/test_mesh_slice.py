import numpy as np
import pytest
import trimesh
from shapes import box, scene_of

from neural_shadows.reports.figures.mesh_slice import slice_mesh, slice_rays

RADIUS = 0.5


def test_bounds_of_a_sphere_are_its_chords():
    ball = slice_mesh(scene_of(trimesh.creation.icosphere(5, RADIUS)))
    np.testing.assert_allclose(np.linalg.norm(ball.outline, axis=2), RADIUS, atol=3e-3)
    rays = slice_rays(ball, 101)
    assert rays.direction @ [1, -1] > 0  # from the upper left
    for t in (0 * rays.chord, rays.chord):
        np.testing.assert_allclose(np.linalg.norm(rays.at(t), axis=1), 1)
    inside = np.abs(rays.offset) < 0.98 * RADIUS
    half = np.sqrt(RADIUS**2 - rays.offset[inside] ** 2)
    middle = np.sqrt(1 - rays.offset[inside] ** 2)
    np.testing.assert_allclose(rays.t_lb[inside], middle - half, atol=5e-3)
    np.testing.assert_allclose(rays.t_ub[inside], middle + half, atol=5e-3)
    beside = np.abs(rays.offset) > RADIUS
    assert not rays.hit[beside].any() and rays.hit[inside].all()
    np.testing.assert_allclose(rays.end[beside], rays.chord[beside], atol=1e-5)


@pytest.mark.parametrize(("extents", "across"), [((1, 0.5, 0.2), 0), ((0.2, 0.5, 1), 2)])
def test_slice_runs_along_the_greatest_horizontal_extent(extents, across):
    cut = slice_mesh(scene_of(box(*extents)))
    np.testing.assert_array_equal(cut.across, np.eye(3)[across])
    np.testing.assert_allclose(np.abs(cut.outline).max(axis=(0, 1)), (0.5, 0.25))
