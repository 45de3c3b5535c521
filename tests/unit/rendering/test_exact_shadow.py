import numpy as np
import pytest
import trimesh
from shapes import looking, scene_of, unit

from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import SHADING_OFFSET, render_gbuffer


@pytest.mark.parametrize("light", [unit(0, 1, 0), unit(1, 1, 0.5), unit(-3, 1.5, 1)])
def test_shadow_of_a_sphere_lies_where_it_must(light):
    scene = scene_of(trimesh.creation.icosphere(5))
    assert scene.ground == pytest.approx(-1, abs=1e-6)
    middle = -light / light[1]
    view = looking(middle + (4, 3, 4), light, target=middle, fov=30)
    frame = render_gbuffer(scene, view, 300, 200)
    visibility = exact_visibility(scene.tracer, frame)
    on_ground = ~frame.is_object[frame.lit_side]
    p = frame.p[on_ground].astype(float)
    np.testing.assert_allclose(p[:, 1], -1 + SHADING_OFFSET, atol=1e-5)
    from_axis = np.linalg.norm(p - (p @ light)[:, None] * light, axis=1)
    wrong = visibility[frame.lit_side[on_ground]] != (from_axis > 1)
    assert np.count_nonzero(wrong) < 0.001 * len(p)
    assert np.abs(from_axis[wrong] - 1).max(initial=0) < 2e-3  # the facets' depth below the sphere
