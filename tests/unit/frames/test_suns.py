"""Frames under a sun, of an object on its stage: lights, maps, and methods beside the exact shadow."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from neural_shadows.frames.buffers import CHANNELS, buffers_of
from neural_shadows.frames.draw_sequences import STEP, draw_sequence
from neural_shadows.frames.draw_settings import FrameKind, draw_setting, light_map_of
from neural_shadows.frames.draw_twins import twin_of
from neural_shadows.frames.kernel_features import (
    FULL_FOCAL,
    FULL_WIDTH,
    PENUMBRA_PIXELS,
    kernel_feature,
)
from neural_shadows.frames.light_size import light_size
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.gbuffer import lens_of
from neural_shadows.rendering.light_shape import light_shape
from neural_shadows.rendering.light_shapes.sun import DISTANCE
from neural_shadows.rendering.soft_shadows import soft_visibility
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.arrangement import UP
from neural_shadows.shadow_maps.light_filters import hard_visibility, soft_disc_visibility

SUN = light_shape({"shape": "sun", "min_elevation_deg": 30.0})
PICTURE = {"kind": "perspective", "fov": 120, "resolution": 512}
SIZE = 96, 64


@pytest.fixture(scope="module")
def stage(tmp_path_factory):
    """A ball of 1 m on the ground."""
    ball = tmp_path_factory.mktemp("ball") / "mesh.ply"
    trimesh.creation.icosphere(4).export(ball)
    return SoftScene({"generate": "stage", "seed": 1, "inserted": {"ball": "y"}}, [ball])


def sun_of(stage, degrees):
    radius = SUN.radius_of(degrees, "degrees", stage.at_rest.size)
    return FrameKind(*SIZE, 55, None, PICTURE, radius=radius, shape=SUN)


def seen(stage, kind, seed=0, motion=None):
    setting = draw_setting(stage, kind, np.random.default_rng(seed))
    scene = stage.at_rest if motion is None else stage.moved(motion)
    surface = see_surface(scene, setting.camera, *SIZE)
    light_map = light_map_of(kind.light_map, stage, setting.centre, shape=SUN)
    return SoftFrame(scene, surface, setting.centre, light_map, 0, SUN)


def exact(frame, radius, samples):
    """Visibility of the frame's points."""
    light = {"centre": frame.centre, "radii": [radius], "shape": SUN, "samples": samples}
    args = frame.scene, frame.surface.camera, *SIZE
    (image,) = soft_visibility(*args, **light, surfaces=[frame.surface])
    return image.ravel()[frame.surface.pixel]


def test_directions_are_those_of_the_domain(stage):
    kind, size = sun_of(stage, 0.27), stage.at_rest.size
    settings = [draw_setting(stage, kind, np.random.default_rng(k)) for k in range(40)]
    to_light = np.array([setting.centre for setting in settings]) - stage.at_rest.ball[0]
    distances = np.linalg.norm(to_light, axis=1)
    assert np.allclose(distances, DISTANCE * size)
    heights = to_light @ UP / distances
    assert 0.5 <= heights.min() < 0.6 and heights.max() > 0.9
    assert kind.radius / distances[0] == pytest.approx(np.tan(np.radians(0.27)))


def test_the_map_fits_the_scene(stage):
    frame = seen(stage, sun_of(stage, 1.0))
    vertices = frame.scene.joined.vertices.astype(np.float64)
    faces, places = frame.light_map.places_of(vertices - frame.centre)
    assert (faces == 0).all() and places.min() > 0 and places.max() < 512
    assert np.ptp(places, axis=0).max() > 0.6 * 512
    distances = np.linalg.norm(vertices - frame.centre, axis=1)
    assert distances.min() > frame.light_map.near
    # Depths are exact to a small part of the bias, so far away as they are.
    texels = np.unique(frame.light_map.texels_of(frame.from_light))
    traced, _ = frame.light_map.first_hits(frame.scene.tracer, texels)
    errors = np.abs(traced - frame.depths[texels])
    assert np.quantile(errors, 0.99) < 0.2 * frame.bias.min()


def test_a_balls_shadow(stage):
    """A hard shadow where the ball is in the way, by rays and by the map."""
    kind = sun_of(stage, 0.0)
    for seed in range(3):
        frame = seen(stage, kind, seed)
        to_light = (frame.centre - stage.at_rest.ball[0]) / DISTANCE / frame.scene.size
        ground = frame.surface.face < 2
        to_ball = np.array([0, 0.5, 0]) - frame.surface.p
        away = np.linalg.norm(np.cross(to_ball, to_light), axis=1)
        sure = ground & (np.abs(away - 0.5) > 0.02)
        visible = 1.0 * (away > 0.5)
        by_map = hard_visibility(frame.light_map, frame.depths, frame.from_light, frame.bias)
        assert 0.02 < 1 - visible[sure].mean() < 0.6
        assert np.array_equal(by_map[sure], visible[sure])
        assert np.array_equal(exact(frame, 0, samples=1)[sure], visible[sure])


def test_methods_of_maps_look_near_the_scene(stage):
    """PCSS searches for blockers where there can be some; moments tell depths of the scene apart."""
    frame = seen(stage, sun_of(stage, 3.0))
    radius = SUN.radius_of(3.0, "degrees", stage.at_rest.size)
    truth = exact(frame, radius, samples=64)
    receivers = frame.light_map, frame.depths, frame.from_light, frame.surface.n_g, frame.bias
    keys = frame.surface.pixel
    facing = frame.cosines > 0.2
    by_pcss = soft_disc_visibility(*receivers, radius=radius, keys=keys)
    hard = hard_visibility(*receivers[:3], frame.bias)
    soft_error, hard_error = (
        np.mean(np.square(visible - truth)[facing]) for visible in (by_pcss, hard)
    )
    assert soft_error < 0.2 * hard_error
    # A map of all distances would find no blocker in a search as wide as the sky.
    anywhere = replace(frame.light_map, near=0.0)
    blind = soft_disc_visibility(anywhere, *receivers[1:], radius=radius, keys=keys)
    assert np.mean(np.square(blind - truth)[facing]) > 2 * soft_error
    buffers = buffers_of(frame.scene, frame.surface, frame.light_map).astype(np.float32)
    z, hard, msm = (buffers[k].ravel()[frame.surface.pixel][facing] for k in (0, 6, 8))
    assert 0 < z.min() < 0.5 and 0.5 < z.max() < 2  # told apart in float16
    assert np.mean(np.abs(hard - msm)) < 0.05


def test_widths_of_penumbrae_as_a_feature(stage):
    """Similar triangles at the sun's distance: 2 tan α times the distance to the blocker."""
    frame, size = seen(stage, sun_of(stage, 1.0)), stage.at_rest.size
    images = buffers_of(frame.scene, frame.surface, frame.light_map)
    buffers = {name: image.astype(np.float32) for name, image in zip(CHANNELS, images)}
    lens = lens_of(frame.surface.camera, *SIZE)
    radius = SUN.radius_of(1.0, "degrees", size)
    light = light_size(radius, radius, size, SUN.AWAY)
    pixels = PENUMBRA_PIXELS * kernel_feature("penumbra_pcss", buffers, lens, light)
    blocked = (buffers["hard"] == 0) & (buffers["gap"] < -0.01) & (pixels < PENUMBRA_PIXELS)
    width = 2 * np.tan(np.radians(1.0)) * -buffers["gap"] / np.maximum(buffers["d"], 1e-3)
    expected = width * lens.focal * FULL_WIDTH / (2 * FULL_FOCAL)
    assert blocked.sum() > 50
    assert np.allclose(pixels[blocked], expected[blocked], rtol=0.01)


def test_perturbed_frames_and_sequences_turn_the_sun(stage):
    """By the angle that a light at one scene size would move."""
    kind = sun_of(stage, 1.0)
    rng, size = np.random.default_rng(4), stage.at_rest.size
    setting = draw_setting(stage, kind, rng)
    told = {"light": 0.007, "eye": 0.001, "turn_deg": 1.0}
    middle = stage.at_rest.ball[0]

    def turned(centres):
        to_light = np.array(centres) - middle
        to_light /= np.linalg.norm(to_light, axis=1, keepdims=True)
        return np.linalg.norm(np.diff(to_light, axis=0), axis=1)

    twins = [twin_of(stage, kind, setting, told, rng) for _ in range(30)]
    angles = [turned([setting.centre, twin.centre])[0] for twin in twins]
    assert 0.003 < np.max(angles) < 0.007 * 3**0.5
    # By a texel: its angle at the scene's size, and not at the sun's distance.
    by_texels = {"light_texels": 1.0, "light_radii": 0.0, "eye_pixels": 0.0}
    twins = [twin_of(stage, kind, setting, by_texels, rng) for _ in range(30)]
    texel = 2 * stage.at_rest.ball[1] / PICTURE["resolution"] / size
    assert 0.3 * texel < max(turned([setting.centre, t.centre])[0] for t in twins) < 2 * texel
    steps = turned([s.centre for s in draw_sequence(stage, kind, "light", 4, rng)])
    assert 0.2 * STEP < steps.max() < 3 * STEP


def test_the_inserted_object_moves(stage):
    settings = draw_sequence(stage, sun_of(stage, 1.0), "object", 3, np.random.default_rng(5))
    ground, ball = stage.moved(settings[2].motion).objects
    assert np.array_equal(ground.vertices, stage.at_rest.objects[0].vertices)
    moved = np.ptp([ball.vertices.mean(0), stage.at_rest.objects[1].vertices.mean(0)], axis=0)
    assert moved.max() > 0.5 * STEP * stage.at_rest.size
