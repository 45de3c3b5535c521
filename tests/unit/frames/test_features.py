"""Features beside the specification's vectors, and what must hold of them whatever the frame."""

import numpy as np
import pytest

from neural_shadows.frames.feature_names import KPNSM_FEATURES
from neural_shadows.frames.features import named_features
from neural_shadows.frames.kernel_features import penumbra_pixels
from neural_shadows.frames.light_size import LightSize, light_size
from neural_shadows.frames.penumbra_widths import penumbra_model
from neural_shadows.rendering.gbuffer import Lens

FOCAL = 983.5  # pixels, of its 2048 × 1024 frames
LENS, LIGHT = Lens(np.float32(1), FOCAL), light_size(0.02, 0.025, 4.0)
EIGHT = ("cosine", "c_v_by_d", "z_f", "penumbra", "behind", "z_b_by_z", "z_b", "base_msm")


def buffers(seed=0):
    """Of 4 × 6 pixels, about half of them lit."""
    rng = np.random.default_rng(seed)
    drawn = {
        **{"z": (0.2, 1), "gap": (-0.1, 0.02), "d": (0.2, 2), "c_e": (-1, 1), "c_v": (0.1, 1)},
        **{"msm": (0, 1), "pcf": (0, 1), "rays": (0, 1), "ray_penumbra": (-0.01, 0.01)},
    }
    found = {name: np.float32(rng.uniform(*ends, (4, 6))) for name, ends in drawn.items()}
    return found | {"hard": np.float32(rng.uniform(0, 1, (4, 6)) < 0.5)}


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
    pixels = penumbra_pixels(**told, light=LightSize(0, 0.01), focal=983.5)
    exact = 2 * 0.01 * (0.8 - 0.5) / 0.5 / 0.6 * 983.5
    assert pixels[0, 0] == pytest.approx(exact * 2048 / (2 * 983.5), rel=1e-3)
    half = penumbra_pixels(**told, light=LightSize(0, 0.01), focal=983.5 / 2)
    assert half[0, 0] == pytest.approx(pixels[0, 0] / 2)


def test_the_eight_planes_of_its_code():
    """Spec: 1.2 and 1.3; W = 2048 of a focal length of 983.5, lit points are not behind anything."""
    told = buffers()
    planes = dict(zip(EIGHT, named_features(EIGHT, told, LENS, LIGHT)))
    z, d, c_e, c_v, lit = (told[name] for name in ("z", "d", "c_e", "c_v", "hard"))
    z_b = np.where(lit == 1, z, np.minimum(z, z + told["gap"]))
    p = (z - z_b) * 0.005 / (z_b + 1e-5) / d * 2048 * np.sqrt(c_v / (np.abs(c_e) + 1e-5))
    exact = [c_e, c_v / d, z, np.clip(p, 0, 50) / 50, z - z_b, z_b / z, z_b, told["msm"]]
    for name, plane in zip(EIGHT, exact):
        assert np.allclose(planes[name], plane, rtol=1e-4, atol=1e-6), name
    assert np.unique(planes["penumbra"]).size > 5 and planes["penumbra"].max() <= 1
    assert not planes["penumbra"][lit == 1].any() and not planes["behind"][lit == 1].any()


def test_penumbra_by_rays_is_that_by_the_map():
    """Where all rays meet the map's blocker; without a blocker it is none."""
    told = buffers()
    z_b = told["z"] + np.where(told["hard"] == 1, 0, np.minimum(told["gap"], 0))
    told["ray_penumbra"] = (told["z"] - z_b) * LIGHT.share / (z_b + 1e-5)
    names = ("ray_penumbra", "penumbra", "log_d", "base_rays")
    by_rays, by_map, log_d, base = named_features(names, told, LENS, LIGHT)
    assert np.allclose(by_rays, by_map, rtol=1e-5) and by_rays.max() > 0.01
    assert np.allclose(np.exp(log_d), told["d"]) and np.array_equal(base, told["rays"])
    (none,) = named_features(names[:1], told | {"ray_penumbra": 0 * z_b - 1}, LENS, LIGHT)
    assert not none.any()


def test_variants():
    """Other bases, and what its table 4 has in the penumbra's place."""
    told, names = buffers(), ("base_hard", "base_pcf", "r_e", "penumbra", "penumbra_pcss")
    hard, pcf, r_e, slanted, straight = named_features(names, told, LENS, LIGHT)
    assert np.array_equal(hard, told["hard"]) and np.array_equal(pcf, told["pcf"])
    assert np.all(r_e == np.float32(0.8))
    root = np.sqrt(told["c_v"] / np.abs(told["c_e"]))
    seen = (slanted > 0) & (slanted < 1) & (straight < 1)
    assert seen.sum() > 3
    assert np.allclose(slanted[seen], (straight * root)[seen], rtol=1e-3)


def test_a_point_light_has_no_penumbra_and_a_pixel_without_surface_no_features():
    told = buffers()
    (point,) = named_features(("penumbra",), told, LENS, light_size(0.0, 0.0, 4.0))
    assert not point.any()
    empty = dict.fromkeys(told, np.zeros((4, 6), np.float32)) | {"hard": np.ones((4, 6))}
    names = tuple(name for name in KPNSM_FEATURES if name not in ("base_hard", "r_e", "log_d"))
    assert not named_features(names, empty, LENS, LIGHT).any()
