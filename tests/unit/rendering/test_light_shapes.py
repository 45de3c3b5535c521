"""Shapes of lights beside closed forms: samples, half-planes, a shape of one's own."""

import re

import numpy as np
import pytest
from checkout import ROOT
from half_planes import CENTRE, visible

from neural_shadows.rendering import light_shapes
from neural_shadows.rendering.light_samples import random_shifts, ring_vectors, sequence_run
from neural_shadows.rendering.light_shape import SPHERE, light_shape
from neural_shadows.rendering.light_shapes.sun import DISTANCE

PANEL = light_shape({"shape": "rectangle", "aspect": 0.4})
SUN = light_shape({"shape": "sun"})
SIZES = [0.1, 0.3]


@pytest.mark.parametrize("turned", [False, True])
def test_half_plane_before_a_rectangle(turned):
    """Its share in front of a straight edge is linear, along its longer or its shorter side."""
    facing = [0.0, -1.0, 0.0] if not turned else [1e-9, -1.0, 0.0]  # the longer side along z
    shape = light_shape({"shape": "rectangle", "aspect": 0.4, "facing": facing})
    radii = [shape.radius_of(size, "metres", 1.0) for size in SIZES]
    images, x = visible(radii, shape)
    edge = x * (1 - CENTRE[1])  # seen on the panel's plane, past the half-plane 1 m high
    for size, image in zip(SIZES, images):
        half = 0.4 * size if turned else size
        expected = np.clip((edge + half) / (2 * half), 0, 1)
        assert expected.min() < 0.1 and expected.max() > 0.9
        assert np.abs(image - expected).max() < 0.04
        assert abs((image - expected).mean()) < 2e-3


@pytest.mark.parametrize("angle", [0.27, 1.0])
@pytest.mark.parametrize("elevation", [90, 40])
def test_half_plane_before_a_sun(angle, elevation):
    """A penumbra is as wide as the distance to its blocker times 2 tan α."""
    height, tilt = 0.5, np.radians(elevation)
    size = 60.0  # of the scene: the ground's side
    centre = DISTANCE * size * np.array([0, np.sin(tilt), np.cos(tilt)])
    reach = height / np.sin(tilt) * np.tan(np.radians(angle))  # half of the width
    radius = SUN.radius_of(angle, "degrees", size)
    (image,), x = visible([radius], SUN, centre, height, 2 * reach)
    t = np.clip(-x / reach, -1, 1)
    expected = 1 - (np.arccos(t) - t * np.sqrt(1 - t * t)) / np.pi
    assert np.abs(image - expected).max() < 0.04
    assert abs((image - expected).mean()) < 2e-3
    inside = (image > 0.02) & (image < 0.98)
    width = np.ptp(x[inside])
    # 2 % of a disc's area lie within 0.11 of its radius at either side.
    assert width == pytest.approx(0.89 * 2 * reach, rel=0.05)


def test_samples_of_a_rectangle_are_uniform():
    radii, count = np.array([0.1, 0.2, 0.4]), 4096
    to_light = np.empty((2, 3 * count, 3), np.float32)
    points = np.array([[0, 0, 0], [3, 1, -2]], np.float32)
    PANEL.ring_vectors(
        points,
        random_shifts(np.array([7, 8]), 3),
        sequence_run(0, count),
        CENTRE,
        radii,
        np.full(3, count),
        to_light,
    )
    on_light = (to_light + points[:, None] - CENTRE).astype(float)
    assert np.abs(on_light[..., 1]).max() < 1e-6  # in its plane, from any point
    half = np.array([1.0, 0.4]) / PANEL.radius_of(1, "metres", 1.0)
    edges = np.concatenate([[0], radii])
    for samples in on_light[..., [0, 2]] / half:
        for k, ring in enumerate(samples.reshape(3, -1, 2)):
            scales = np.abs(ring).max(1)
            assert edges[k] - 1e-6 <= scales.min() and scales.max() <= edges[k + 1] + 1e-6
            shared = np.sort((scales**2 - edges[k] ** 2) / (edges[k + 1] ** 2 - edges[k] ** 2))
            assert np.abs(shared - (np.arange(count) + 0.5) / count).max() < 0.005
            # Along the rim: each side has a quarter, evenly.
            places = np.sort(along_rim(ring / scales[:, None]))
            assert np.abs(places - (np.arange(count) + 0.5) / count).max() < 0.005
    # Cells of equal area of the whole: a chi-square far below that of independent samples (63).
    to_light = np.empty((1, count, 3), np.float32)
    PANEL.ring_vectors(
        points[:1],
        random_shifts(np.array([9]), 1),
        sequence_run(0, count),
        CENTRE,
        np.array([0.4]),
        np.array([count]),
        to_light,
    )
    samples = (to_light[0] - CENTRE)[:, [0, 2]] / half / 0.4
    cells, _, _ = np.histogram2d(*samples.T, bins=8, range=[[-1, 1]] * 2)
    assert np.sum((cells - count / 64) ** 2 / (count / 64)) < 40


def along_rim(places):
    """Position on the rim of the square [−1, 1]² in turn, in [0, 1)."""
    x, y = places.T
    on_x = np.abs(x) >= np.abs(y)
    side = np.where(on_x, np.where(x > 0, 0, 2), np.where(y > 0, 1, 3))
    within = np.choose(side, [y, -x, -y, x])
    return (side + (within + 1) / 2) / 4


def test_a_sphere_is_the_default():
    """Its samples are those of `ring_vectors`, to the bit."""
    arguments = (
        np.ones((5, 3), np.float32),
        random_shifts(np.arange(5), 2),
        sequence_run(3, 4),
        CENTRE,
        np.array([0.1, 0.3]),
    )
    expected, vectors = np.empty((2, 5, 8, 3), np.float32)
    ring_vectors(*arguments, np.array([4, 4]), expected)
    for shape in (SPHERE, light_shape(None), light_shape({"shape": "sphere"})):
        shape.ring_vectors(*arguments, np.array([4, 4]), vectors)
        assert vectors.tobytes() == expected.tobytes()
        assert shape.radius_of(0.25, "metres", 7.0) == shape.reach(0.25) == 0.25
        assert shape.radius_of(0.25, "scene_sizes", 2.0) == 0.5


def test_areas_and_reach():
    radius = PANEL.radius_of(0.5, "metres", 1.0)
    assert np.pi * radius**2 == pytest.approx(1.0 * 0.4)
    assert PANEL.reach(radius) == pytest.approx(np.hypot(0.5, 0.2))
    upright = light_shape({"shape": "rectangle", "facing": [0.0, 0.0, 2.0]})
    assert np.ptp(upright.corners(), axis=0).tolist() == [2, 2, 0]


def test_the_shape_of_the_documentation(tmp_path, monkeypatch):
    """A shape is one file: the recipe of config/README.md, found by its name."""
    text = (ROOT / "config/README.md").read_text(encoding="utf-8")
    path, module = re.search(r"```python\n# (\S*light_shapes/\S+)\n(.*?)```", text, re.S).groups()
    name = path.rpartition("/")[2].removesuffix(".py")
    (tmp_path / f"{name}.py").write_text(module, encoding="utf-8")
    monkeypatch.setattr(light_shapes, "__path__", [*light_shapes.__path__, str(tmp_path)])
    shape = light_shape({"shape": name})
    radius = shape.radius_of(0.3, "metres", 1.0)
    assert np.pi * radius**2 == pytest.approx(1.5 * 3**0.5 * 0.3**2)
    (image,), x = visible([radius], shape)
    assert image.min() < 0.02 and image.max() > 0.98
    # By symmetry half of it is seen from under the edge, which its centre is right above.
    assert image[np.abs(x) < 3e-3].mean() == pytest.approx(0.5, abs=0.02)
