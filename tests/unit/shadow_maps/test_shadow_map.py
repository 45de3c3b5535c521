import numpy as np
import pytest
import trimesh
from shapes import Y_UP, bumpy_sphere, looking, scene_of, sheet, unit

from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.shadow_maps.shadow_map import (
    receivers_of,
    shadow_map_lit,
    shadow_map_square,
    texel_heights,
)

W, H = 300, 200
LIGHTS = [unit(0, 1, 0), unit(1, 1, 0.5), unit(-3, 1.5, 1), unit(0, 1, 1)]


@pytest.fixture(scope="module")
def bumpy():
    return scene_of(bumpy_sphere(5))


def lit_by(scene, frame, resolution, **whole):
    """What a map says of the points on a frame's lit side, (m,) bool."""
    square = shadow_map_square(scene.objects[0].vertices, frame.view.light)
    return shadow_map_lit(scene.tracer, receivers_of(square, frame), resolution, **whole)


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


# Of 23,000 and more receivers: the first is looked up in a table, the second traced singly.
@pytest.mark.parametrize("resolution", [256, 1024])
def test_a_whole_map_answers_as_the_texels_in_use_do(bumpy, resolution):
    frame = render_gbuffer(bumpy, looking((1, 2, 2), unit(1, 1, 0.5)), W, H)
    lazy = lit_by(bumpy, frame, resolution)
    assert 0.01 < lazy.mean() < 0.99
    np.testing.assert_array_equal(lit_by(bumpy, frame, resolution, whole=True), lazy)


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
