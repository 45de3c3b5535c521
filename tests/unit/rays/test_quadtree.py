import numpy as np
import pytest
from scipy.integrate import quad as integrate

from neural_shadows.rays.quadtree import DISK_RADIUS, build_quadtree, disk_area


def grid(resolution):
    """Texel centres (a, b)."""
    axis = (2 * np.arange(resolution) + 1) / resolution - 1
    return np.meshgrid(axis, axis)


def half_plane(resolution):
    return grid(resolution)[0] > 0


def disc(resolution):
    a, b = grid(resolution)
    return np.hypot(a - 0.2, b + 0.1) < 0.5


def single_texel(resolution):
    silhouette = np.zeros((resolution, resolution), bool)
    silhouette[5, 9] = True
    return silhouette


SILHOUETTES = [half_plane, disc, single_texel]


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


@pytest.mark.parametrize("silhouette", SILHOUETTES)
@pytest.mark.parametrize("resolution, min_quad", [(16, 1), (64, 1), (64, 4), (128, 2)])
def test_leaves_are_those_of_the_definition(silhouette, resolution, min_quad):
    image = silhouette(resolution)
    quads = build_quadtree(image, min_quad)
    assert quads.dtype == np.int32
    assert np.array_equal(quads, leaves_by_definition(image, min_quad))


@pytest.mark.parametrize("silhouette", SILHOUETTES)
def test_leaves_tile_the_disk_without_overlap(silhouette):
    quads = build_quadtree(silhouette(64), 1)
    covered = np.zeros((64, 64), int)
    for row, column, size in quads:
        covered[row : row + size, column : column + size] += 1
    assert covered.max() == 1
    lines = 2 * quads / 64
    areas = [disk_area(c - 1, r - 1, c - 1 + s, r - 1 + s) for r, c, s in lines]
    assert min(areas) > 0
    assert sum(areas) == pytest.approx(np.pi * DISK_RADIUS**2, rel=1e-12)


def test_known_trees():
    # The axis divides the half plane: four quadrants.
    corners = [[0, 0], [0, 64], [64, 0], [64, 64]]
    assert build_quadtree(half_plane(128), 1).tolist() == [[*corner, 64] for corner in corners]
    # Nothing, or everything, is one quad.
    assert build_quadtree(np.zeros((32, 32), bool), 1).tolist() == [[0, 0, 32]]
    assert build_quadtree(np.ones((32, 32), bool), 1).tolist() == [[0, 0, 32]]
    # One texel: three siblings at each of the four levels, and the texel's own three.
    sizes, counts = np.unique(build_quadtree(single_texel(16), 1)[:, 2], return_counts=True)
    assert dict(zip(sizes.tolist(), counts.tolist())) == {1: 4, 2: 3, 4: 3, 8: 3}


def test_wrong_sizes_are_refused():
    for shape in [(12, 12), (16, 8), (0, 0)]:
        with pytest.raises(ValueError, match="no power of two"):
            build_quadtree(np.zeros(shape, bool), 1)
    for min_quad in (0, 3, 32):
        with pytest.raises(ValueError, match="min_quad"):
            build_quadtree(np.zeros((16, 16), bool), min_quad)


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
