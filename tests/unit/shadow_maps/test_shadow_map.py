import numpy as np
import pytest
import trimesh
from shapes import AXES, Y_UP, box, bumpy_sphere, looking, octahedron, prepared, sheet, unit

from neural_shadows.rendering.gbuffer import ShadingPoints, ground_height, primary_hits
from neural_shadows.rendering.shading import reference_visibility, shade, visibility
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.shadow_maps.shadow_map import (
    depth_test,
    receivers_of,
    shadow_map_frame,
    shadow_map_lit,
    texel_heights,
    texels_of,
)

W, H = 300, 200
LIGHTS = [unit(0, 1, 0), unit(1, 1, 0.5), unit(-3, 1.5, 1), unit(0, 1, 1)]


@pytest.fixture(scope="module")
def bumpy():
    return prepared(bumpy_sphere(5))


def views_of(mesh, tracer, count):
    """Viewpoints as they are evaluated, `count` of each set."""
    return draw_viewpoints(
        mesh,
        tracer,
        up=Y_UP,
        ground=True,
        light_domain={"domain": "sphere", "min_elevation_deg": 20},
        view_sets=["shadow", "surface"],
        indices=range(count),
        width=W,
        height=H,
        seed=7,
    )


def frame_points(mesh, tracer, view, width=W, height=H):
    points = primary_hits(mesh, tracer, view, width, height, ground_height(mesh, Y_UP))
    return points, receivers_of(shadow_map_frame(mesh.vertices, view.light), points)


def psnr(a, b):
    return -10 * np.log10(max(np.mean((a.astype(float) - b) ** 2), 1e-10))


def points_at(p, light, cos_theta):
    """Shading points by themselves, without a frame."""
    p = np.asarray(p, np.float32)
    cosine = np.full(len(p), cos_theta, np.float32)
    index = np.arange(len(p))
    is_object = np.zeros(len(p), bool)
    return ShadingPoints(len(p), 1, light, index, is_object, index, p, cosine, cosine)


@pytest.mark.parametrize("light", LIGHTS)
def test_square_is_the_smallest(bumpy, light):
    vertices = bumpy[0].vertices * np.float32([1, 0.5, 0.8]) + np.float32([0.1, 0, 0.05])
    frame = shadow_map_frame(vertices, light)
    across = (vertices.astype(float) @ frame.basis.T)[:, :2]
    extents = np.ptp(across, axis=0)
    assert frame.side == pytest.approx(extents.max(), abs=1e-6)
    low, high = across.min(0) - frame.corner, frame.corner + frame.side - across.max(0)
    np.testing.assert_allclose(low, high, atol=1e-6)  # the object in the middle
    np.testing.assert_allclose(low, (frame.side - extents) / 2, atol=1e-6)
    assert frame.top > (vertices @ light).max()


@pytest.mark.parametrize("cos_theta", [1.0, 0.5, 0.1, 1e-3])
@pytest.mark.parametrize("resolution", [128, 2048, 32768])
def test_bias_is_the_stated_one(cos_theta, resolution):
    mesh, tracer = prepared(sheet(0.5, 0.6))
    texel = 1.2 / resolution
    slope = min(0.5 + 0.75 * np.sqrt(1 / cos_theta**2 - 1), 20)
    bias = slope * texel + 1e-4
    rounding = 1e-6  # float32 heights of about 1
    for depth, lit in [(bias - rounding, True), (bias + rounding, False)]:
        points = points_at([[0.31, 0.5 - depth, 0.17]], Y_UP, cos_theta)
        receivers = receivers_of(shadow_map_frame(mesh.vertices, Y_UP), points)
        assert shadow_map_lit(tracer, receivers, resolution).tolist() == [lit]


def test_points_off_the_map_are_lit():
    mesh, tracer = prepared(sheet(0.5, 0.6))
    points = points_at([[0.59, 0, 0], [0.61, 0, 0], [0, 0, -0.61], [0, 0, -0.59]], Y_UP, 1.0)
    receivers = receivers_of(shadow_map_frame(mesh.vertices, Y_UP), points)
    assert shadow_map_lit(tracer, receivers, 128).tolist() == [False, True, True, False]


@pytest.mark.parametrize("light", AXES)
def test_light_along_an_axis(light):
    """A box, its side faces edge-on to the light: its shadow is the rectangle behind it."""
    half = np.array([0.25, 0.375, 0.5])
    mesh, tracer = prepared(box(*2 * half))
    frame = shadow_map_frame(mesh.vertices, light)
    along = np.flatnonzero(light)[0]
    assert frame.side == 2 * np.delete(half, along).max()
    rng = np.random.default_rng(4)
    p = rng.uniform(-0.7, 0.7, (5000, 3))
    p[:, along] = light[along] * rng.choice([-1.0, 1.0], 5000)
    # Clear of the border by a texel's diagonal.
    beyond = np.delete(np.abs(p) - half, along, axis=1).max(axis=1)
    p = p[np.abs(beyond) > 1.5 * frame.side / 128]
    dark = np.delete(np.abs(p) < half, along, axis=1).all(axis=1) & (p @ light < 0)
    assert 400 < dark.sum() < len(p) / 2
    points = points_at(p, light, 1.0)
    assert np.array_equal(~reference_visibility(tracer, points), dark)
    assert np.array_equal(~shadow_map_lit(tracer, receivers_of(frame, points), 128), dark)


def test_a_sheet_edge_on_casts_no_shadow():
    shape = sheet(0.0, 0.4)
    shape.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [0, 0, 1]))
    shape.vertices[:, 0] = 0
    mesh, tracer = prepared(shape)
    frame = shadow_map_frame(mesh.vertices, Y_UP)
    assert frame.side == pytest.approx(0.8)
    x, z = np.meshgrid(np.concatenate([np.geomspace(1e-6, 0.4, 30), [-1e-6, -0.1]]), [-0.39, 0.1])
    points = points_at(np.stack([x, 0 * x - 0.5, z], 2).reshape(-1, 3), Y_UP, 1.0)
    assert reference_visibility(tracer, points).all()
    for resolution in (128, 2048):
        assert shadow_map_lit(tracer, receivers_of(frame, points), resolution).all()


def test_vertices_on_the_border_of_the_map():
    """An octahedron's: they are on the sphere and on the border of its map at once."""
    mesh, tracer = prepared(octahedron())
    frame = shadow_map_frame(mesh.vertices, Y_UP)
    assert (frame.side, *frame.corner) == (2, -1, -1)
    vertices = np.array([v for v in mesh.vertices if v[1] == 0])
    points = points_at(vertices, Y_UP, 1.0)
    receivers = receivers_of(frame, points)
    assert receivers.place.tolist() == [[0.5, 0], [0, 0.5]]  # at 1 they are off the map
    assert shadow_map_lit(tracer, receivers, 256).all()


@pytest.mark.parametrize("light", LIGHTS)
def test_coplanar_faces_cast_one_shadow(light):
    """A box whose sides are cut along both diagonals, so that each point is covered twice."""
    shape = box(0.8, 0.8, 0.8)
    single = prepared(shape)
    turned = shape.copy()
    turned.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [0, 1, 0]))
    turned.apply_transform(np.diag([1.0, -1, 1, 1]))  # the other diagonals, on all six sides
    turned.invert()
    double = prepared(trimesh.util.concatenate([shape, turned]))
    assert len(double[0].faces) == 24
    view = looking((1.5, 2, 2.5), light)
    pictures = []
    for mesh, tracer in (single, double):
        points, receivers = frame_points(mesh, tracer, view)
        maps = [shadow_map_lit(tracer, receivers, n) for n in (256, 2048)]
        pictures.append(
            [shade(points, lit) for lit in (reference_visibility(tracer, points), *maps)]
        )
    # Nothing shadows itself: the object's pixels, and the ground's, are as with single faces.
    for one, two in zip(*pictures, strict=True):
        assert np.mean(np.abs(one - two) > 1e-5) < 1e-3


def test_depth_is_that_of_texel_centres():
    mesh, tracer = prepared(trimesh.creation.icosphere(4))
    light = unit(1, 1, 0.5)
    frame = shadow_map_frame(mesh.vertices, light)
    n = 64
    heights = texel_heights(tracer, frame, n, np.arange(n * n)).reshape(n, n)
    rows, columns = np.nonzero(np.isfinite(heights))
    assert abs(len(rows) / n**2 - np.pi / 4) < 0.01  # a disc in its square
    place = frame.corner + (np.stack([columns, rows], 1) + 0.5) * frame.side / n
    surface = np.column_stack([place, heights[rows, columns]]) @ frame.basis
    # The facets of a convex body: a point on one of them is inside of all the others.
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    beyond = surface[::20] @ mesh.face_normals.T - np.sum(centres * mesh.face_normals, axis=1)
    np.testing.assert_allclose(beyond.max(axis=1), 0, atol=2e-6)
    assert (surface @ light > -0.05).all()  # on the lit side


# Of 23,000 and more receivers: the first two are looked up in a table, the others traced singly.
@pytest.mark.parametrize("resolution", [128, 256, 1024, 2048])
@pytest.mark.parametrize("light", [unit(0, 1, 0), unit(1, 1, 0.5)])
def test_lazy_map_equals_the_full_one(bumpy, resolution, light):
    mesh, tracer = bumpy
    _, receivers = frame_points(mesh, tracer, looking((1, 2, 2), light))
    assert 4 * len(receivers.on_map) > 256**2 and 4 * len(receivers.on_map) < 1024**2
    full = texel_heights(tracer, receivers.frame, resolution, np.arange(resolution**2))
    expected = depth_test(receivers, full[texels_of(receivers, resolution)], resolution)
    assert 0.01 < expected.mean() < 0.99
    np.testing.assert_array_equal(shadow_map_lit(tracer, receivers, resolution), expected)


def test_texels_of_the_finest_map_are_numbered_exactly(bumpy):
    _, receivers = frame_points(*bumpy, looking((1, 2, 2), unit(1, 1, 0.5)))
    texels = texels_of(receivers, 32768)
    assert texels.max() > 2**29
    row, column = np.divmod(texels, 32768)
    np.testing.assert_array_equal(column, np.floor(receivers.place[0].astype(float) * 32768))
    np.testing.assert_array_equal(row, np.floor(receivers.place[1].astype(float) * 32768))


@pytest.mark.parametrize("light", LIGHTS)
def test_shadow_of_a_sphere_lies_where_it_must(light):
    mesh, tracer = prepared(trimesh.creation.icosphere(5))
    middle = -light / light[1]
    points, receivers = frame_points(mesh, tracer, looking(middle + (4, 4, 4), light, middle))
    on_ground = ~points.is_object[points.facing]
    p = points.p[on_ground].astype(float)
    from_axis = np.linalg.norm(p - (p @ light)[:, None] * light, axis=1)
    assert np.count_nonzero(from_axis < 1) > 300
    for resolution in (128, 512, 2048):
        wrong = shadow_map_lit(tracer, receivers, resolution)[on_ground] != (from_axis > 1)
        # Off the outline by a texel's diagonal and the facets' depth, or near the foot, where
        # the sphere is no further from the ground than the bias is deep.
        texel = 2 / resolution
        foot = np.linalg.norm(p - (0, -1, 0), axis=1)
        near = np.abs(from_axis - 1) < 1.5 * texel + 2e-3
        near |= foot**2 / 2 < 30 * texel
        assert wrong[near].sum() == wrong.sum()
        assert wrong.sum() < 4 * texel * len(wrong)


@pytest.mark.parametrize("light", LIGHTS)
def test_shadow_of_a_box_lies_where_it_must(light):
    mesh, tracer = prepared(box(0.8, 0.8, 0.8))
    middle = -0.4 * light / light[1]
    points, receivers = frame_points(mesh, tracer, looking(middle + (1, 3, 1), light, middle))
    on_ground = ~points.is_object[points.facing]
    p = points.p[on_ground].astype(float)
    # Against the three slabs of the box: the ray p + s l is inside all of them at once.
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.stack([(-0.4 - p) / light, (0.4 - p) / light])
    enter = np.where(light == 0, np.where(np.abs(p) < 0.4, -np.inf, np.inf), ends.min(0)).max(1)
    leave = np.where(light == 0, np.where(np.abs(p) < 0.4, np.inf, -np.inf), ends.max(0)).min(1)
    lit = ~((enter < leave) & (leave > 0))
    exact = reference_visibility(tracer, points)[on_ground]
    assert np.count_nonzero(exact != lit) == 0
    wrong = shadow_map_lit(tracer, receivers, 2048)[on_ground] != lit
    assert np.count_nonzero(wrong) < 0.003 * len(lit)


def test_error_halves_when_the_resolution_doubles(bumpy):
    mesh, tracer = bumpy
    resolutions = [128, 256, 512, 1024, 2048]
    errors, ratios = [], []
    for view in views_of(mesh, tracer, 8):
        points, receivers = frame_points(mesh, tracer, view)
        exact = reference_visibility(tracer, points)
        picture = shade(points, exact)
        lits = [shadow_map_lit(tracer, receivers, n) for n in resolutions]
        errors.append([np.mean(visibility(points, lit ^ exact)) for lit in lits])
        ratios.append([psnr(shade(points, lit), picture) for lit in lits])
    errors, ratios = np.mean(errors, axis=0), np.mean(ratios, axis=0)
    halvings = errors[:-1] / errors[1:]
    assert (halvings > 1.6).all() and (halvings < 2.5).all(), halvings
    steps = np.diff(ratios)
    assert (steps > 2).all() and (steps < 4).all(), steps


def test_thesis_reference_agrees_with_the_exact_one():
    """A 32768² map is the exact shadow to PSNR 50 and more [4.1]."""
    mesh, tracer = prepared(bumpy_sphere(6))
    pictures, references = [], []
    for view in views_of(mesh, tracer, 8):
        points, receivers = frame_points(mesh, tracer, view)
        pictures.append(shade(points, shadow_map_lit(tracer, receivers, 32768)))
        references.append(shade(points, reference_visibility(tracer, points)))
    # Over all frames together: a mean of ratios would be led by the identical frames.
    assert psnr(np.array(pictures), np.array(references)) >= 50


@pytest.mark.parametrize("resolution", [128, 1024, 32768])
@pytest.mark.parametrize("light", [*LIGHTS, unit(5, 1, 0), unit(3, 0.5, 4)])
def test_a_plane_in_the_light_has_no_acne(light, resolution):
    """Up to 84 degrees from the normal: the bias covers the depth within a texel."""
    mesh, tracer = prepared(sheet(0.0, 0.7))
    points = primary_hits(mesh, tracer, looking((0.5, 2, 1.5), light), W, H, None)
    receivers = receivers_of(shadow_map_frame(mesh.vertices, light), points)
    assert len(receivers.on_map) > 0.99 * len(points.facing) > 5000
    assert shadow_map_lit(tracer, receivers, resolution).all()
