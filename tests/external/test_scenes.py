"""Targets of generated scenes beside Mitsuba's samples of the same light, pixel by pixel."""

import numpy as np
import pytest

from neural_shadows.frames.draw_settings import FrameKind, draw_setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.soft_shadows import PLACES, see_places, soft_visibility

WIDTH, HEIGHT, RADIUS = 64, 48, 0.25  # the light's in metres
SAMPLES, THEIRS = 256, 16  # of each of a pixel's eight places
MAP = {"kind": "perspective", "fov": 120, "resolution": 512}


@pytest.mark.parametrize("name", ["room", "stairs", "tree"])
def test_our_target(name, run_outside, measured):
    """In standard errors of their samples, for which eight places' own visibilities are needed."""
    soft = SoftScene({"generate": name, "seed": 2026, "inserted": {}}, [])
    kind = FrameKind(WIDTH, HEIGHT, 55, None, MAP, RADIUS)
    setting, scene = draw_setting(soft, kind, np.random.default_rng(5)), soft.at_rest
    camera, mesh = setting.camera, scene.joined
    light = {"centre": setting.centre, "radii": [RADIUS], "samples": SAMPLES}

    def visibility(places) -> np.ndarray:
        surfaces = see_places(scene, camera, WIDTH, HEIGHT, places)
        told = light | {"adaptive": False, "surfaces": surfaces}
        return soft_visibility(scene, camera, WIDTH, HEIGHT, **told)[0]

    target, by_place = visibility(PLACES), [visibility([place]) for place in PLACES]
    seen = run_outside(
        "mitsuba_visibility.py",
        **{"vertices": mesh.vertices, "faces": mesh.faces, "places": PLACES, "samples": THEIRS},
        **{"eye": camera.eye, "target": camera.target, "up": camera.up, "fov": camera.fov},
        **{"width": WIDTH, "height": HEIGHT, "centre": setting.centre, "radius": RADIUS, "seed": 1},
    )["seen"]
    beside_light = (seen >= 0).all(0)
    off = target - seen.mean(0) / THEIRS

    variance = np.mean([one * (1 - one) for one in by_place], axis=0) / len(PLACES)
    error = np.sqrt(variance * (1 / THEIRS + 1 / SAMPLES))
    some = beside_light & (error > 0.015)  # at 128 samples fewer are far from a normal error
    z = off[some] / error[some]
    plain = beside_light & ((target == 0) | (target == 1))
    share = np.mean(np.abs(z) > 3)
    measured(
        f"{name} beside Mitsuba: {len(z)} pixels in penumbrae, mean {off[some].mean():+.5f}, "
        f"rms {np.sqrt(np.mean(off[some] ** 2)):.4f}; z: mean {z.mean():+.3f}, deviation "
        f"{z.std():.3f}, largest {np.abs(z).max():.2f}, {100 * share:.2f} % beyond 3; "
        f"{plain.sum()} lit or dark, mean {off[plain].mean():+.6f}, "
        f"largest {np.abs(off[plain]).max():.4f}"
    )
    assert len(z) > 100 and plain.sum() > 500
    assert abs(z.mean()) < 4 / np.sqrt(len(z)) and 0.9 < z.std() < 1.1
    assert share < 0.01  # 0.0027 of a normal distribution
    assert np.abs(off[plain]).mean() < 1e-3
