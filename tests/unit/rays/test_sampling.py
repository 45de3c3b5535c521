from itertools import pairwise

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree
from scipy.stats import chi2, chisquare
from shapes import prepared, unit

from neural_shadows.rays.poisson_disk import PatternBank
from neural_shadows.rays.quadtree import DISK_RADIUS, build_quadtree, disk_area
from neural_shadows.rays.sampling import sample_direction, sample_quads, uniform_on_disk
from neural_shadows.rays.silhouette import plane_basis

RESOLUTION = 16
CELLS = 3  # a quad is divided into 3 × 3 cells, the smallest quads too
BANKS = {"poisson_quadtree": PatternBank(1), "uniform_quadtree": None}


@pytest.fixture(scope="module")
def quads():
    """Quads of 1 to 4 texels around a disc, some of them cut by the rim."""
    axis = (2 * np.arange(RESOLUTION) + 1) / RESOLUTION - 1
    a, b = np.meshgrid(axis, axis)
    return build_quadtree(np.hypot(a - 0.5, b + 0.3) < 0.3, 1)


def quad_of(quads, points):
    """Index of the quad that each point is in."""
    index = np.full((RESOLUTION, RESOLUTION), -1)
    for i, (row, column, size) in enumerate(quads):
        index[row : row + size, column : column + size] = i
    column, row = np.floor((points + 1) / 2 * RESOLUTION).astype(int).T
    return index[row, column]


def draw_in_quads(quads, sampler, per_quad, draws):
    """(q, draws, 2): one random point of each of many draws of `per_quad` points in each quad.

    Points of a pattern keep away from each other; one of each pattern is independent of the
    others, as the chi-square test wants them. A repeated quad is as good as a repeated draw.
    """
    rng = np.random.default_rng(0)
    repeated = np.repeat(quads, draws, axis=0)
    points = sample_quads(repeated, RESOLUTION, per_quad * len(repeated), rng, BANKS[sampler])
    points = points.reshape(len(repeated), per_quad, 2)  # they come in the order of the quads
    chosen = rng.integers(per_quad, size=len(repeated))
    return points[np.arange(len(repeated)), chosen].reshape(-1, draws, 2)


def density_p_value(quads, points):
    """Chi-square test of points (q, draws, 2), uniform in what each quad shares with the disk."""
    statistic = degrees = 0
    for (row, column, size), drawn in zip(quads, points, strict=True):
        lines = size * np.arange(CELLS + 1) / CELLS
        rows, columns = 2 * (row + lines) / RESOLUTION - 1, 2 * (column + lines) / RESOLUTION - 1
        counts = np.histogram2d(drawn[:, 1], drawn[:, 0], bins=(rows, columns))[0]
        assert counts.sum() == len(drawn)  # none is outside its quad
        areas = [
            [max(0, disk_area(left, bottom, right, top)) for left, right in pairwise(columns)]
            for bottom, top in pairwise(rows)
        ]
        expected = len(drawn) * np.array(areas) / np.sum(areas)
        few = expected < 5
        assert counts[few].sum() < 40  # slivers of cells
        statistic += np.sum((counts - expected)[~few] ** 2 / expected[~few])
        degrees += np.sum(~few) - 1
    return chi2.sf(statistic, degrees)


@pytest.mark.parametrize("sampler", BANKS)
@pytest.mark.parametrize(
    ("per_quad", "draws"), [(2, 20_000), (3, 20_000), (15, 20_000), (2, 100_000)]
)
def test_quadtree_samplers_keep_to_their_density(quads, sampler, per_quad, draws):
    if draws == 100_000:
        # The rim alone, with more draws: what is thinned there must not thin out towards it.
        far = 2 * np.abs(2 * quads[:, :2] + quads[:, 2:] - RESOLUTION) + 2 * quads[:, 2:]
        quads = quads[np.hypot(*far.T) > 2 * RESOLUTION]
        assert len(quads) > 5
    assert density_p_value(quads, draw_in_quads(quads, sampler, per_quad, draws)) > 1e-3


def test_uniform_sampler_keeps_to_its_density():
    """In 8 rings of equal area, 12 sectors each."""
    points = uniform_on_disk(200_000, np.random.default_rng(3))
    distance = np.linalg.norm(points, axis=1)
    assert distance.max() < DISK_RADIUS
    angle = np.arctan2(points[:, 1], points[:, 0])
    bins = (np.linspace(0, DISK_RADIUS**2, 9), np.linspace(-np.pi, np.pi, 13))
    assert chisquare(np.histogram2d(distance**2, angle, bins)[0].ravel()).pvalue > 1e-3


@pytest.mark.parametrize("sampler", BANKS)
@pytest.mark.parametrize("extra", [-9, 0, 5])
def test_points_are_divided_evenly_and_the_remainder_at_random(quads, sampler, extra):
    q = len(quads)
    m = 4 * q + extra if extra >= 0 else q + extra  # less points than quads: one or none each
    gets_more = np.zeros(q)
    for seed in range(1500):
        rng = np.random.default_rng(seed)
        points = sample_quads(quads, RESOLUTION, m, rng, BANKS[sampler])
        assert points.shape == (m, 2)
        counts = np.bincount(quad_of(quads, points), minlength=q)
        assert set(counts - m // q) <= {0, 1}
        gets_more += counts - m // q
    assert gets_more.sum() == 1500 * (m % q)
    if m % q:
        # Without replacement the counts scatter less than chi-square's by 1 − (m mod q) / q.
        variance = 1500 * (m % q) / q * (1 - m % q / q)
        statistic = np.sum((gets_more - gets_more.mean()) ** 2) / variance * (q - 1) / q
        assert chi2.sf(statistic, q - 1) > 1e-3


def test_patterns_keep_their_distance_in_whole_quads():
    quads = np.array([[4, 4, 4], [4, 8, 4], [8, 8, 2], [10, 8, 1], [7, 2, 1]])
    for seed in range(50):
        rng = np.random.default_rng(seed)
        points = sample_quads(quads, RESOLUTION, 12 * len(quads), rng, BANKS["poisson_quadtree"])
        for (_, _, size), inside in zip(quads, points.reshape(-1, 12, 2)):
            closest = cKDTree(inside).query(inside, k=2)[0][:, 1].min()
            # n r² = 0.615 of full sets, less what the search for r goes down.
            assert closest > np.sqrt(0.5 / 12) * 2 * size / RESOLUTION


@pytest.fixture(scope="module")
def ball():
    return prepared(trimesh.creation.icosphere(subdivisions=3, radius=0.5))[1]


def rays_of(tracer, sampler, direction, m=2000, resolution=64, min_quad=1):
    sampling = {
        "sampler": sampler,
        "points_per_direction": m,
        "silhouette_resolution": resolution,
        "min_quad": min_quad,
    }
    rng = np.random.default_rng(5)
    return sample_direction(tracer, direction, sampling, rng=rng, bank=PatternBank(1))


@pytest.mark.parametrize("sampler", [*BANKS, "uniform"])
@pytest.mark.parametrize("direction", [unit(1, 2, 3), unit(0, 0, -1), unit(-1, 0.001, 0)])
def test_rays_go_into_the_sphere_and_quadtrees_follow_the_silhouette(ball, sampler, direction):
    origins = rays_of(ball, sampler, direction.astype(np.float32))
    assert origins.shape == (2000, 3) and origins.dtype == np.float32
    assert np.abs(np.linalg.norm(origins.astype(float), axis=1) - 1).max() < 1e-6
    assert (origins @ direction < -9e-4).all()
    offsets = origins @ np.stack(plane_basis(direction), axis=1)
    at_border = np.mean(np.abs(np.linalg.norm(offsets, axis=1) - 0.5) < 0.05)
    # The ring of 0.45 to 0.55 is 10 % of the disk.
    assert at_border == pytest.approx(0.1, abs=0.03) if sampler == "uniform" else at_border > 0.6
