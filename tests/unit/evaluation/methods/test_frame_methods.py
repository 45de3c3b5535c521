"""Every method on one frame of a plate over a ground, beside many rays."""

import numpy as np
import pytest
import trimesh
from opened import settings_of
from shapes import prepared

from neural_shadows.evaluation.method import visibility
from neural_shadows.evaluation.methods.denoised import DENOISERS
from neural_shadows.evaluation.registry import (
    FRAME_METHODS,
    LABELS,
    METHODS,
    NETWORK_LOOK,
    look_of,
)
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.soft_shadows import soft_visibility
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.arrangement import scene_of
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.generators.plate import LIGHT, arrange_plate
from neural_shadows.settings.kinds import kinds
from neural_shadows.shadow_maps.light_map import cube_map, perspective_map

CENTRE, RADIUS, SIZE = np.array([0.0, LIGHT, 0.0]), 0.1, (96, 64)
DOWN = np.array([0.0, -1.0, 0.0])


@pytest.fixture(scope="module")
def frame():
    box = prepared(trimesh.creation.box((1.2, 0.2, 1.2)))[0]
    scene = scene_of(arrange_plate(0.9), {"box": box})
    camera = Camera(np.array([0.6, 1.5, 1.4]), np.array([0.05, 0, 0]), np.array([0, 1.0, 0]), 18.0)
    surface = see_surface(scene, camera, *SIZE)
    return SoftFrame(scene, surface, CENTRE, perspective_map(CENTRE, DOWN, 90.0, 512))


@pytest.fixture(scope="module")
def target(frame):
    """Of a point and of a sphere: (2, n) float32."""
    told = {"centre": CENTRE, "radii": [0.0, RADIUS], "samples": 32}
    images = soft_visibility(frame.scene, frame.surface.camera, *SIZE, **told)
    return images.reshape(2, -1)[:, frame.surface.pixel]


def test_a_filter_without_width_leaves_what_it_filters(frame):
    constants = {k: v[len(v) // 2] for k, v in METHODS["pcss"].constants.items()}
    alone = visibility(METHODS["pcss"], frame, RADIUS, constants)
    none, wide = (
        visibility(METHODS["pcss_post"], frame, RADIUS, constants | {"width": width})
        for width in (0.0, 1.5)
    )
    assert np.array_equal(none, alone) and np.abs(wide - alone).mean() > 1e-4


def answers_of(method, frame, radius):
    """With all of its constants; those of the least error are what is used.

    Constants that are searched one after another are changed one at a time, the others in the middle: all
    settings of six methods took 70 s.
    """
    middle = {name: values[len(values) // 2] for name, values in method.constants.items()}
    for constants in settings_of(method):
        if not method.joint and len(constants.items() - middle.items()) > 1:
            continue
        found = visibility(method, frame, radius, constants)
        assert found.shape == (len(frame.surface.p),) and found.dtype == np.float32
        assert found.min() >= 0 and found.max() <= 1
        yield found


ASKED = [key for key, method in METHODS.items() if method.answer]


@pytest.mark.parametrize("key", ASKED)
def test_hard_shadows_of_a_point(key, frame, target):
    """All are near; what they blur is a band round the edge."""
    assert 0.1 < np.mean(target[0] < 0.5) < 0.5
    method = METHODS[key]
    errors = [np.mean((one - target[0]) ** 2) for one in answers_of(method, frame, 0.0)]
    assert min(errors) < (0.02 if key == "pcf_15" else 0.01)


def test_soft_shadows_of_a_sphere(frame, target):
    assert np.mean((target[1] > 0.02) & (target[1] < 0.98)) > 0.1
    errors = {
        key: min(np.mean((one - target[1]) ** 2) for one in answers_of(method, frame, RADIUS))
        for key, method in METHODS.items()
        if method.answer
    }
    # One blocker at one height, whose penumbra is 9 texels wide.
    assert errors["pcss"] < 1e-4 and errors["pcf_disc"] < 1e-4
    assert errors["pcss_post"] < 3e-4 and errors["mssm"] < 1e-4
    for family in ("pcf", "vsm", "msm"):
        assert 2 * errors[f"{family}_9"] < errors[f"{family}_3"] < errors["hard"]
    assert errors["evsm_9"] < errors["vsm_3"]
    nothing = min(np.mean((light - target[1]) ** 2) for light in (0, 1))
    assert errors["hard"] < nothing / 5
    for few, more in ((1, 4), (4, 16), (16, 64)):
        assert 2 * errors[f"rt_{more}"] < errors[f"rt_{few}"]
    for key, denoiser in DENOISERS.items():
        for count in denoiser.counts[:3]:
            assert 4 * errors[f"rt_{count}_{key}"] < errors[f"rt_{count}"]


def test_no_two_methods_or_looks_are_taken_for_each_other():
    families = kinds("evaluation/methods").values()
    assert sum(len(family.METHODS) for family in families) == len(METHODS)
    assert "" not in LABELS.values() and len({*LABELS.values()}) == len(LABELS)
    looks = [*{*map(look_of, FRAME_METHODS)}, NETWORK_LOOK]
    for of_each in ({one.name for one in looks}, {one.symbol for one in looks}):
        assert len(of_each) == len(looks)
    assert len({(one.colour, one.marker) for one in looks}) == len(looks)


def test_constants_are_those_of_the_first_of_a_kind():
    for key, method in FRAME_METHODS.items():
        first = METHODS[method.tuned_as or key]
        assert first.constants == method.constants and not first.tuned_as


def test_the_first_constants_of_a_last_filter_are_none():
    first = {name: m.constants[name][0] for m in FRAME_METHODS.values() for name in m.of_last}
    assert first == {"width": 0, "bleeding": 0}


@pytest.fixture(scope="module")
def cube_frame(frame):
    return SoftFrame(frame.scene, frame.surface, CENTRE, cube_map(CENTRE, 512))


@pytest.mark.parametrize("key", ["hard", "pcf_9", "pcss", "msm_9", "mssm"])
def test_a_cube_tells_what_a_picture_does(key, frame, cube_frame):
    constants = settings_of(METHODS[key])[0]
    found = [visibility(METHODS[key], of, RADIUS, constants) for of in (cube_frame, frame)]
    assert np.mean((found[0] - found[1]) ** 2) < 2e-3
