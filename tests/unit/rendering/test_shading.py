import numpy as np
import trimesh
from shapes import looking, scene_of, unit

from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.shading import AMBIENT, BACKGROUND, shade

W, H = 150, 100


def test_shades_are_the_stated_ones():
    scene = scene_of(trimesh.creation.icosphere(5))
    view = looking((0, 1, 6), unit(1, 1, 0), target=(-1.5, -0.5, 0), fov=60)
    frame = render_gbuffer(scene, view, W, H)
    visibility = exact_visibility(scene.tracer, frame)
    image = shade(frame, visibility)
    flat = image.ravel()
    sky = np.setdiff1d(np.arange(W * H), frame.pixel)
    assert len(sky) > 100 and (flat[sky] == np.float32(BACKGROUND)).all()
    lit, dark = (frame.pixel[~frame.is_object & (visibility == value)] for value in (1, 0))
    assert len(lit) > 50 and len(dark) > 50
    np.testing.assert_allclose(flat[lit], 0.25 + 0.75 * np.sqrt(0.5), atol=1e-6)
    np.testing.assert_array_equal(flat[dark], np.float32(AMBIENT))
    # A penumbra: half of the light, wherever some comes.
    half = shade(frame, visibility / 2)
    np.testing.assert_allclose(half.ravel()[lit], 0.25 + 0.375 * np.sqrt(0.5), atol=1e-6)
