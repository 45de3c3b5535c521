import numpy as np
import pytest
import trimesh
from shapes import Y_UP, bumpy_sphere, looking, scene_of, sheet, unit

from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.shadow_maps.depth_test import depth_test
from neural_shadows.shadow_maps.rasterise import rasterised_heights
from neural_shadows.shadow_maps.shadow_map import receivers_of, shadow_map_square
from neural_shadows.shadow_maps.trace import looked_up_heights, texel_heights
from neural_shadows.shadow_maps.unorm16 import from_unorm16, to_unorm16

W, H = 300, 200
LIGHTS = [unit(0, 1, 0), unit(1, 1, 0.5), unit(-3, 1.5, 1), unit(0, 1, 1)]


@pytest.fixture(scope="module")
def bumpy():
    return scene_of(bumpy_sphere(5))


def lit_by(scene, frame, resolution, depth_bias=0.0, pcf=False, sixteen_bit=False):
    """What a map says of the points on a frame's lit side, (m,) float32 in [0, 1]."""
    square = shadow_map_square(scene.objects[0].vertices, frame.view.light)
    receivers = receivers_of(square, frame)

    def heights_at(texels):
        heights = looked_up_heights(scene.tracer, square, resolution, texels)
        return from_unorm16(to_unorm16(heights, square), square) if sixteen_bit else heights

    return depth_test(receivers, resolution, heights_at, pcf=pcf)(depth_bias)


def points_at(p, light, cosine):
    """Shading points by themselves, without a frame."""
    p = np.asarray(p, np.float32)
    cosine, index = np.full(len(p), cosine, np.float32), np.arange(len(p))
    view, on_ground = looking((0, 0, 3), light), np.zeros(len(p), bool)
    return GBuffer(view, len(p), 1, index, on_ground, index, p, cosine, cosine)


@pytest.mark.parametrize("cosine", [1.0, 0.5, 0.1, 1e-3])
@pytest.mark.parametrize("resolution", [128, 2048, 32768])
def test_bias_is_the_stated_one(cosine, resolution):
    scene = scene_of(sheet(0.5, 0.6))
    slope = min(0.5 + 0.75 * np.sqrt(1 / cosine**2 - 1), 20)
    bias = slope * 1.2 / resolution + 1e-4
    for depth, lit in [(bias - 1e-6, True), (bias + 1e-6, False)]:  # but for rounding
        # The second is off the map.
        points = points_at([[0.31, 0.5 - depth, 0.17], [0.61, 0, 0]], Y_UP, cosine)
        assert lit_by(scene, points, resolution).tolist() == [lit, True]
    # A depth bias adds to it, or takes away.
    for depth, lit in [(bias - 0.01 - 1e-6, True), (bias - 0.01 + 1e-6, False)]:
        points = points_at([[0.31, 0.5 - depth, 0.17]], Y_UP, cosine)
        assert lit_by(scene, points, resolution, -0.01).tolist() == [lit]


@pytest.mark.parametrize("light", LIGHTS[1:])
@pytest.mark.parametrize("resolution", [100, 700])
def test_a_rasterised_map_is_the_traced_one(bumpy, light, resolution):
    (mesh,) = bumpy.objects
    square = shadow_map_square(mesh.vertices, light)
    traced = texel_heights(bumpy.tracer, square, resolution, np.arange(resolution**2))
    found = rasterised_heights(mesh.vertices, mesh.faces, square, resolution).ravel()
    covered = np.isfinite(traced)
    np.testing.assert_array_equal(np.isfinite(found), covered)
    difference = np.abs(found[covered] - traced[covered])
    # A traced ray starts a rounding beside its texel's centre, and faces may be steep.
    assert difference.max() < 1e-5 and np.quantile(difference, 0.999) < 1e-6


def test_a_texel_on_an_edge_is_covered_whichever_way_the_faces_turn():
    """Centres of 4² texels fall on the diagonal of the square's two triangles."""
    for winding in (1, -1):
        mesh = scene_of(sheet(0.25, 0.5, winding)).objects[0]
        square = shadow_map_square(mesh.vertices, Y_UP)
        found = rasterised_heights(mesh.vertices, mesh.faces, square, 4)
        np.testing.assert_allclose(found, 0.25, rtol=1e-6)


def test_pcf_weighs_the_four_nearest_texels():
    """A sheet over half of the map, and points below the middle of it on their way across."""
    both = trimesh.util.concatenate([sheet(0.5, 0.25), sheet(-0.9, 1.0)])
    scene, n = scene_of(both), 64
    h = 2 / n  # the upper sheet's rim, at −0.25 and 0.25, is that of texels
    way = np.linspace(-0.6, 0.6, 25) * h
    # Along both axes: whichever of the map's is which.
    for axis in (0, 2):
        p = np.full((len(way), 3), [0.0, -0.5, 0.0])
        p[:, axis] = 0.25 + way
        found = lit_by(scene, points_at(p, Y_UP, 1.0), n, pcf=True)
        np.testing.assert_allclose(found, np.clip(0.5 + way / h, 0, 1), atol=1e-4)
        np.testing.assert_array_equal(lit_by(scene, points_at(p, Y_UP, 1.0), n), way >= 0)
    corner = points_at([[0.25, -0.5, 0.25]], Y_UP, 1.0)
    np.testing.assert_allclose(lit_by(scene, corner, n, pcf=True), 0.75, atol=1e-4)


def test_sixteen_bits_round_to_a_65534th_of_the_extent(bumpy):
    square = shadow_map_square(bumpy.objects[0].vertices, unit(1, 1, 0.5))
    step = (square.highest - square.lowest) / 65534
    heights = np.linspace(square.lowest, square.highest, 200_001, dtype=np.float32)
    codes = to_unorm16(heights, square)
    assert codes.dtype == np.uint16 and codes.min() == 1 and codes.max() == 65_535
    found = from_unorm16(codes, square)
    assert np.abs(found - heights).max() == pytest.approx(step / 2, rel=0.02)
    assert len(np.unique(found)) == 65_535
    # Exactly those of the levels, however many there are at once.
    levels = np.arange(65_535)[None] * step + np.float64([[square.lowest], [square.lowest]])
    again = from_unorm16(to_unorm16(levels.astype(np.float32), square), square)
    np.testing.assert_array_equal(again, levels.astype(np.float32))
    none = to_unorm16(np.float32([-np.inf]), square)
    assert none == 0 and from_unorm16(none, square) == -np.inf


def test_points_are_compared_with_heights_of_sixteen_bits():
    both = trimesh.util.concatenate([sheet(-0.9, 0.6), sheet(0.30001, 0.6), sheet(0.5, 0.1)])
    scene, n = scene_of(both), 128
    stored = -0.9 + np.round(1.20001 / 1.4 * 65534) * 1.4 / 65534
    assert abs(stored - 0.30001) > 5e-6
    for beside, lit in [(2e-6, 1), (-2e-6, 0)]:
        points = points_at([[0.4, stored - 0.5 * 1.2 / n - 1e-4 + beside, 0.4]], Y_UP, 1.0)
        for pcf in (False, True):
            assert lit_by(scene, points, n, pcf=pcf, sixteen_bit=True).tolist() == [lit]
    # An object all at one height has but one code.
    flat = scene_of(sheet(0.5, 0.6))
    points = points_at([[0.31, 0.4, 0.17], [0.31, 0.6, 0.17]], Y_UP, 1.0)
    assert lit_by(flat, points, 128, sixteen_bit=True).tolist() == [0, 1]


def test_depth_is_that_of_texel_centres():
    scene = scene_of(trimesh.creation.icosphere(4))
    (mesh,), light, n = scene.objects, unit(1, 1, 0.5), 64
    square = shadow_map_square(mesh.vertices, light)
    heights = texel_heights(scene.tracer, square, n, np.arange(n * n)).reshape(n, n)
    rows, columns = np.nonzero(np.isfinite(heights))
    assert abs(len(rows) / n**2 - np.pi / 4) < 0.01  # a disc in its square
    place = square.corner + (np.stack([columns, rows], 1) + 0.5) * square.side / n
    surface = np.column_stack([place, heights[rows, columns]]) @ square.basis
    # The facets of a convex body: a point on one of them is inside of all the others.
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    beyond = surface[::20] @ mesh.face_normals.T - np.sum(centres * mesh.face_normals, axis=1)
    np.testing.assert_allclose(beyond.max(axis=1), 0, atol=2e-6)
    assert (surface @ light > -0.05).all()  # on the lit side


def test_error_halves_when_the_resolution_doubles(bumpy):
    errors = []
    for view in draw_viewpoints(bumpy, ["shadow", "surface"], range(8), W / H, 7):
        frame = render_gbuffer(bumpy, view, W, H)
        exact = exact_visibility(bumpy.tracer, frame)
        maps = [frame.visibility(lit_by(bumpy, frame, n)) for n in (128, 256, 512, 1024, 2048)]
        errors.append([np.abs(visibility - exact).mean() for visibility in maps])
    errors = np.mean(errors, axis=0)
    np.testing.assert_allclose(errors[:-1] / errors[1:], 2, atol=0.4)


def test_thesis_reference_agrees_with_the_exact_one(bumpy):
    """A 32768² map is the exact shadow to PSNR 50 and more [4.1]."""
    squares = []
    for view in draw_viewpoints(bumpy, ["shadow", "surface"], range(8), W / H, 7):
        frame = render_gbuffer(bumpy, view, W, H)
        picture = shade(frame, frame.visibility(lit_by(bumpy, frame, 32768)))
        reference = shade(frame, exact_visibility(bumpy.tracer, frame))
        squares.append(np.mean((picture - reference) ** 2))
    # Over all frames together: a mean of ratios would be led by the identical frames.
    assert -10 * np.log10(np.mean(squares)) >= 50


@pytest.mark.parametrize("light", [*LIGHTS, unit(5, 1, 0), unit(3, 0.5, 4)])
def test_a_plane_in_the_light_has_no_acne(light):
    """Up to 84 degrees from the normal: the bias covers the depth within a texel."""
    scene = scene_of(sheet(0.0, 0.7), ground=False)
    frame = render_gbuffer(scene, looking((0.5, 2, 1.5), light), W, H)
    assert len(frame.lit_side) > 5000
    for resolution in (128, 1024, 32768):
        assert lit_by(scene, frame, resolution).all()
