import numpy as np
import pytest
from scipy.integrate import quad as integrate

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
    found = []

    def visit(row, column, size):
        lines = np.array([[row, row + size], [column, column + size]]) * 2 / resolution - 1
        nearest = np.where(lines[:, 0] > 0, lines[:, 0], np.minimum(lines[:, 1], 0))
        if np.hypot(*nearest) >= 1:
            return
        texels = silhouette[row : row + size, column : column + size]
        if size == min_quad or texels.all() or not texels.any():
            found.append((row, column, size))
            return
        half = size // 2
        for i in (0, half):
            for j in (0, half):
                visit(row + i, column + j, half)

    visit(0, 0, resolution)
    return np.array(found)


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


def test_disk_area_is_that_of_quadrature():
    rng = np.random.default_rng(0)
    for _ in range(200):
        left, right = np.sort(rng.uniform(-1.2, 1.2, 2))
        bottom, top = np.sort(rng.uniform(-1.2, 1.2, 2))

        def height(a, bottom=bottom, top=top):
            reach = np.sqrt(max(0.0, DISK_RADIUS**2 - a * a))
            return max(0.0, min(top, reach) - max(bottom, -reach))

        # Where a side of the rectangle or the disk's end makes a kink.
        kinks = [
            s * np.sqrt(max(0.0, DISK_RADIUS**2 - y * y)) for y in (bottom, top, 0) for s in (-1, 1)
        ]
        lines = np.unique(np.clip([left, right, *kinks], left, right))
        pieces = [integrate(height, *ends, epsabs=1e-12)[0] for ends in zip(lines, lines[1:])]
        assert disk_area(left, bottom, right, top) == pytest.approx(sum(pieces), abs=1e-9)
