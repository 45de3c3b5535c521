"""Features beside the specification's vectors, and what must hold of them whatever the frame."""

import numpy as np
import pytest

from neural_shadows.frames.features import (
    kpnsm_features,
    penumbra_pixels,
)
from neural_shadows.frames.penumbra_widths import penumbra_model


def buffers(seed=0):
    rng = np.random.default_rng(seed)
    z = rng.uniform(0.2, 1, (4, 6)).astype(np.float32)
    z_b = z * rng.uniform(0.3, 1, z.shape).astype(np.float32)
    d, c_v = rng.uniform(0.2, 2, z.shape), rng.uniform(0.1, 1, z.shape)
    return {"z": z, "z_b": z_b, "d": d, "c_e": rng.uniform(-1, 1, z.shape), "c_v": c_v}


def test_published_vectors_of_the_penumbra_model():
    def width(z, nearest, farthest, radius=0.25):
        return penumbra_model(*(np.array([x]) for x in (z, nearest, farthest)), radius)[0]

    assert width(4, 1.8, 2.2) == pytest.approx(0.51010, abs=1e-5)
    assert width(4, 3.5, 3.9) == pytest.approx(0.04212, abs=1e-5)
    # A blocker without thickness: by similar triangles. A point light: none.
    assert width(4, 2.0, 2.0) == pytest.approx(2 * 0.25 * (4 - 2) / 2)
    assert width(4, 2.0, 2.0, radius=0.0) == 0
    assert width(4, np.nan, np.nan) == 0


def test_penumbra_is_as_wide_as_similar_triangles_say():
    """Head-on: 2 r (z − z_b) / z_b, seen with a focal length at distance d."""
    one = {"z": 0.8, "z_b": 0.5, "d": 0.6, "c_e": 1.0, "c_v": 1.0}
    told = {name: np.full((1, 1), value, np.float32) for name, value in one.items()}
    pixels = penumbra_pixels(**told, radius=0.01, focal=983.5)
    exact = 2 * 0.01 * (0.8 - 0.5) / 0.5 / 0.6 * 983.5
    assert pixels[0, 0] == pytest.approx(exact * 2048 / (2 * 983.5), rel=1e-3)
    half = penumbra_pixels(**told, radius=0.01, focal=983.5 / 2)
    assert half[0, 0] == pytest.approx(pixels[0, 0] / 2)


def test_kpnsms_planes_in_its_order():
    told = buffers()
    base = np.full((4, 6), 0.25, np.float32)
    planes = kpnsm_features(**told, base=base, radius=0.005, focal=983.5)
    assert planes.shape == (8, 4, 6) and planes.dtype == np.float32
    assert np.allclose(planes[4], told["z"] - told["z_b"], atol=1e-6)
    assert np.allclose(planes[5] * planes[2], planes[6], atol=1e-6)
    assert planes[3].min() >= 0 and planes[3].max() <= 1 and np.all(planes[7] == 0.25)
    lit = kpnsm_features(**told | {"z_b": told["z"]}, base=base, radius=0.005, focal=983.5)
    assert not lit[3].any() and not lit[4].any()
