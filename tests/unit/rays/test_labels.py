import numpy as np
import pytest
import trimesh
from shapes import AXES, box, octahedron, prepared, sheet

from neural_shadows.rays.labels import check_bounds, dual_bounds


def checked_bounds(tracer, origins, directions):
    """`dual_bounds` of rays (n, 3), which keep the rules of bounds."""
    t_lb, t_ub = dual_bounds(tracer, origins, directions)
    directions = np.ascontiguousarray(np.broadcast_to(directions, origins.shape))
    check_bounds(directions, origins[:, None], np.stack([t_lb, t_ub], 1)[:, None], name="test")
    return t_lb, t_ub


def rays_through(count, seed, reach=1.0):
    """Rays that enter the unit sphere at random and aim at a random point within `reach`."""
    rng = np.random.default_rng(seed)
    origins = rng.normal(size=(count, 3))
    origins /= np.linalg.norm(origins, axis=1, keepdims=True)
    targets = rng.uniform(-1, 1, size=(count, 3)) * reach / np.sqrt(3)
    directions = targets - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return origins.astype(np.float32), directions.astype(np.float32)


def rays_to(targets, directions):
    """Rays from the unit sphere to points (n, 3) within it, float32, and their lengths (n,)."""
    along = np.sum(targets * directions, axis=1)
    t = along + np.sqrt(along**2 + 1 - np.sum(targets**2, axis=1))
    origins = (targets - t[:, None] * directions).astype(np.float32)
    return origins, directions.astype(np.float32), t


def slab_method(origins, directions, low, high):
    """Entry and exit of a box in float64; NaN where the ray misses it."""
    o, d = origins.astype(float), directions.astype(float)
    with np.errstate(divide="ignore"):
        near, far = np.sort([(low - o) / d, (high - o) / d], axis=0)
    entry, leave = near.max(axis=1), far.min(axis=1)
    return np.where([entry < leave] * 2, [entry, leave], np.nan)


# The thinnest features are 1e-3; a tenth of that, and one that most rays miss.
BOXES = [(0.8, 0.5, 0.6), (1.2, 1e-3, 1.2), (1.2, 1e-4, 1.2), (0.01, 0.01, 0.01)]


@pytest.mark.parametrize("extents", BOXES)
def test_box_gives_entry_and_exit(extents):
    origins, directions = rays_through(20_000, 0)
    t_lb, t_ub = checked_bounds(prepared(box(*extents))[1], origins, directions)
    assert t_lb.dtype == t_ub.dtype == np.float32
    half = np.array(extents) / 2
    entry, leave = slab_method(origins, directions, -half, half)
    missed = np.isnan(entry)
    assert 0.2 < missed.mean()
    # Within float32 of an edge either answer is right: chords below 1e-4 are left out.
    hit = leave - entry > 0.9e-4
    assert (hit | missed).mean() > 0.999
    assert np.abs(t_lb - entry)[hit].max() < 1e-5
    assert np.abs(t_ub - leave)[hit].max() < 1e-5
    # A miss has the chord, to the bit.
    chord = -2 * np.sum(origins.astype(float) * directions, axis=1)
    assert np.array_equal(t_lb[missed], chord.astype(np.float32)[missed])
    assert np.isinf(t_ub[missed]).all()


def test_the_second_hit_of_nested_spheres_is_the_inner_front():
    outer = trimesh.creation.icosphere(subdivisions=4, radius=0.8)
    inner = trimesh.creation.icosphere(subdivisions=4, radius=0.4)
    tracer = prepared(outer + inner)[1]
    origins, directions = rays_through(3000, 3, reach=0.25)
    t_lb, t_ub = dual_bounds(tracer, origins, directions)
    middle = -np.sum(origins.astype(float) * directions, axis=1)
    distance2 = 1 - middle**2
    aimed = distance2 < 0.3**2
    assert aimed.mean() > 0.9
    for bound, radius in [(t_lb, 0.8), (t_ub, 0.4)]:
        analytic = middle - np.sqrt(np.maximum(radius**2 - distance2, 0))
        assert bound[aimed] == pytest.approx(analytic[aimed], abs=5e-3)


@pytest.mark.parametrize("direction", AXES)
def test_light_along_an_axis(direction):
    """Two components of the direction are 0: no slab or edge test may divide by them."""
    half = np.array([0.25, 0.375, 0.5])
    along = np.flatnonzero(direction)[0]
    grid = np.linspace(-0.625, 0.625, 41)  # steps of 1/32: rays meet edges and diagonals exactly
    targets = np.insert(np.stack(np.meshgrid(grid, grid), -1).reshape(-1, 2), along, 0, axis=1)
    origins, directions, _ = rays_to(targets, np.tile(direction, (len(targets), 1)))
    t_lb, t_ub = checked_bounds(prepared(box(*2 * half))[1], origins, directions)
    beyond = np.delete(np.abs(origins) - half, along, axis=1).max(axis=1)
    middle = np.abs(origins[:, along].astype(float))
    inside, outside = beyond < 0, beyond > 0
    assert inside.sum() > 300 and outside.sum() > 300
    assert t_lb[inside] == pytest.approx((middle - half[along])[inside], abs=3e-7)
    assert t_ub[inside] == pytest.approx((middle + half[along])[inside], abs=3e-7)
    assert t_lb[outside] == pytest.approx(2 * middle[outside], abs=3e-7)
    assert np.isinf(t_ub[outside]).all()


@pytest.mark.parametrize(("cosine", "layers"), [(1.0, 2), (0.03, 2), (1e-3, 1)])
def test_coplanar_faces_count_as_one(cosine, layers):
    """A sheet cut along both diagonals: each point is covered twice, by different triangles.

    Nearly along a single layer, the origin moved past its hit can still be before it.
    """
    turned = trimesh.transformations.rotation_matrix(1, [1, 2, 3])[:3, :3].T
    corners = sheet(0.0, 0.5).vertices @ turned
    faces = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]][: 2 * layers]
    tracer = prepared(trimesh.Trimesh(corners, faces, process=False))[1]
    rng = np.random.default_rng(8)
    angle = rng.uniform(0, 2 * np.pi, 20_000)
    sine = np.sqrt(1 - cosine**2)
    local = np.stack([sine * np.cos(angle), np.full(20_000, -cosine), sine * np.sin(angle)], 1)
    targets = rng.uniform(-0.45, 0.45, (20_000, 3)) * [1, 0, 1] @ turned
    origins, directions, t = rays_to(targets, local @ turned)
    t_lb, t_ub = checked_bounds(tracer, origins, directions)
    # Embree's rounding grows as a ray gets flatter: from 0.01 on it is that of the step itself.
    assert np.abs(t_lb - t).max() < 4e-7 / cosine
    assert np.isinf(t_ub).all()


def test_a_vertex_on_the_sphere():
    """Exactly on it, as two and more of every mesh are: hit at t = 0, or at the chord's end."""
    tracer = prepared(octahedron())[1]
    vertices = np.array(AXES, np.float32)
    t_lb, t_ub = checked_bounds(tracer, vertices, -vertices)
    assert ((0 < t_lb) & (t_lb < 2e-7)).all()
    # Embree's code for AVX2 alone is a last digit off.
    assert ((2 - 2e-7 < t_ub) & (t_ub <= 2)).all()


@pytest.mark.parametrize("bad", [(0, 0), (1, 0.999), (2.000001, np.inf), (0.5, np.nan)])
def test_broken_rules_of_bounds_are_an_error_that_names_the_ray(bad):
    """Rays of one direction that enter at (0, 1, 0) along −y, ℓ = 2."""
    good = [(0.5, 1.5), (2.0, np.inf), (0.5, np.inf), (1.0, 1.0), (1e-7, 2.0), (0.5, 2.00001)]
    direction = np.array([[0, -1, 0]], np.float32)
    origins = np.tile(np.array([0, 1, 0], np.float32), (1, 7, 1))
    bounds = np.array([[*good, bad]], np.float32)
    check_bounds(direction, origins[:, :6], bounds[:, :6], name="good")
    with pytest.raises(RuntimeError) as caught:
        check_bounds(direction, origins, bounds, name="labels x.npy (seed 3)", first=17)
    message = str(caught.value)
    assert message.startswith("labels x.npy (seed 3): ray 6 of direction 17 from [0.0, 1.0, 0.0] ")
    assert f"t_lb = {np.float32(bad[0])}, t_ub = {np.float32(bad[1])} on a chord of 2.0" in message
