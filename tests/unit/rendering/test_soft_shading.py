import numpy as np

from neural_shadows.rendering.shading import AMBIENT, BACKGROUND
from neural_shadows.rendering.soft_shading import soft_shading


def test_a_floor_a_wall_a_ceiling_and_the_sky():
    surface = np.array([[True, True, True, False]])
    cosine, upward = np.array([[0.5, -0.2, 0.0, 0.0]]), np.array([[1.0, 0.0, -1.0, 0.0]])
    shading = soft_shading(surface, cosine, upward)
    dark = [AMBIENT, 0.75 * AMBIENT, 0.5 * AMBIENT, BACKGROUND]
    np.testing.assert_allclose(shading.picture(np.zeros((1, 4))), [dark], rtol=1e-6)
    # Of half of the light half arrives, where a surface faces it.
    half = [AMBIENT + (1 - AMBIENT) * 0.25, *dark[1:]]
    np.testing.assert_allclose(shading.picture(np.full((1, 4), 0.5)), [half], rtol=1e-6)
    assert shading.picture(np.ones((1, 4), np.float32)).max() <= 1
