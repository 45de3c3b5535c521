"""Quadtrees over silhouettes against their definition."""

import numpy as np
import pytest

from neural_shadows.rays.quadtree import DISK_RADIUS, build_quadtree, disk_area

AXIS = (2 * np.arange(64) + 1) / 64 - 1
A, B = np.meshgrid(AXIS, AXIS)  # texel centres
SILHOUETTES = {
    "half plane": A > 0,
    "disc": np.hypot(A - 0.2, B + 0.1) < 0.5,
    "texel": (A == AXIS[9]) & (B == AXIS[5]),
    "nothing": A > 2,
    "all": A < 2,
}


def leaves_by_definition(silhouette, min_quad):
    """The definition read out, in the Z-order of the quads."""
    resolution = len(silhouette)
    leaves = []

    def visit(row, column, size):
        lines = np.array([[row, row + size], [column, column + size]]) * 2 / resolution - 1
        nearest = np.where(lines[:, 0] > 0, lines[:, 0], np.minimum(lines[:, 1], 0))
        if np.hypot(*nearest) >= 1:
            return
        texels = silhouette[row : row + size, column : column + size]
        if size == min_quad or texels.all() or not texels.any():
            leaves.append((row, column, size))
            return
        half = size // 2
        for i in (0, half):
            for j in (0, half):
                visit(row + i, column + j, half)

    visit(0, 0, resolution)
    return np.array(leaves)


@pytest.mark.parametrize("name", SILHOUETTES)
@pytest.mark.parametrize("min_quad", [1, 4])
def test_leaves_are_those_of_the_definition_and_tile_the_disk(name, min_quad):
    quads = build_quadtree(SILHOUETTES[name], min_quad)
    assert quads.dtype == np.int32
    assert np.array_equal(quads, leaves_by_definition(SILHOUETTES[name], min_quad))
    corners = 2 * quads / 64
    areas = [disk_area(c - 1, r - 1, c - 1 + s, r - 1 + s) for r, c, s in corners]
    assert min(areas) > 0
    assert sum(areas) == pytest.approx(np.pi * DISK_RADIUS**2, rel=1e-12)
