"""Settings of frames: clear of objects, the same from the same seed, and refused where none can be."""

from dataclasses import replace

import numpy as np
import pytest

from neural_shadows.errors import InputError
from neural_shadows.frames import draw_sequences
from neural_shadows.frames.draw_sequences import LEAST_CHANGE, STEP, draw_sequence, why_still
from neural_shadows.frames.draw_settings import (
    EYE_CLEARANCE,
    LIGHT_CLEARANCE,
    FrameKind,
    draw_setting,
    is_clear,
    light_map_of,
    lit_from,
)
from neural_shadows.frames.draw_twins import reach, twin_of
from neural_shadows.frames.setting import setting_of
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.frames.uses import SEQUENCES
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.arrangement import Region

PICTURE = {"kind": "perspective", "fov": 120, "resolution": 64}
KIND = FrameKind(64, 32, 55, None, PICTURE, radius=0.25)
WINDOW = FrameKind(64, 64, 55, (512, 256), {"kind": "cube", "resolution": 64}, radius=0.03)


@pytest.fixture(scope="module")
def room():
    return SoftScene({"generate": "room", "seed": 1, "inserted": {}}, [])


def drawn(room, kind=KIND, seed=0):
    return draw_setting(room, kind, np.random.default_rng(seed))


@pytest.mark.parametrize("kind", [KIND, WINDOW])
def test_settings_are_clear_and_see_a_shadow(room, kind):
    scene = room.at_rest
    for seed in range(4):
        setting = drawn(room, kind, seed)
        assert is_clear(scene, setting.camera.eye, EYE_CLEARANCE * scene.size)
        assert is_clear(scene, setting.centre, LIGHT_CLEARANCE * scene.size + kind.radius)
        surface = see_surface(scene, setting.camera, kind.width, kind.height)
        assert len(surface.p) > 0.45 * kind.width * kind.height
        light_map = light_map_of(kind.light_map, room, setting.centre)
        assert np.mean(light_map.texels_of(surface.p - setting.centre) >= 0) > 0.97


def test_the_seed_alone_decides_and_json_keeps_all(room):
    one, same, other = drawn(room, WINDOW), drawn(room, WINDOW), drawn(room, WINDOW, 1)
    assert one.as_json() == same.as_json() == setting_of(one.as_json()).as_json()
    assert one.as_json() != other.as_json()


@pytest.mark.parametrize(
    ("spoilt", "fov", "reason"),
    [
        ("lights", 120, r"room: none of .* the light is in an object or near"),
        ("cameras", 120, "the camera is in an object or near"),
        (None, 10, r"outside the light's map \(\d+\)"),
    ],
)
def test_where_no_frame_can_be_it_is_refused(room, spoilt, fov, reason):
    table = {o.name: o.vertices for o in room.arrangement.objects}["table"].mean(0)
    at = {"lights": table, "cameras": np.array([0.0, 0.6, -2.55])}  # the latter in a wall
    scene = SoftScene({"generate": "room", "seed": 1, "inserted": {}}, [])
    regions = {spoilt: Region(at[spoilt], at[spoilt])} if spoilt else {}
    scene.arrangement = replace(room.arrangement, **regions)
    with pytest.raises(InputError, match=reason):
        drawn(scene, replace(KIND, light_map={**PICTURE, "fov": fov}))


def test_a_path_that_leaves_the_map_is_refused(room, monkeypatch):
    """It starts in the map, where a short one stays; a long one does not."""
    narrow = replace(KIND, light_map={**PICTURE, "fov": 80}, radius=0.05)
    monkeypatch.setattr(draw_sequences, "_DRAWS", 8)
    draw_sequence(room, narrow, "camera", 2, np.random.default_rng(3))
    monkeypatch.setattr(draw_sequences, "STEP", 0.4)
    why = r"room: none of 8 paths \(camera\) can be used: .*outside the light's map \(8\)"
    with pytest.raises(InputError, match=why):
        draw_sequence(room, narrow, "camera", 2, np.random.default_rng(3))


def test_twins_are_near(room):
    setting, size = drawn(room), room.at_rest.size
    told = {"light": 0.007, "eye": 0.001, "turn_deg": 1.0}
    twins = [twin_of(room, KIND, setting, told, np.random.default_rng(k)) for k in range(30)]
    moved = np.array([twin.centre - setting.centre for twin in twins])
    assert 0.006 * size < np.abs(moved).max() <= 0.007 * size
    eyes = np.array([twin.camera.eye - setting.camera.eye for twin in twins])
    assert 0.0008 * size < np.abs(eyes).max() <= 0.001 * size
    views = [t.camera.target - t.camera.eye for t in twins]
    views /= np.linalg.norm(views, axis=1, keepdims=True)
    straight = setting.camera.target - setting.camera.eye
    turned = np.degrees(np.arccos(np.clip(views @ straight / np.linalg.norm(straight), -1, 1)))
    assert 0.5 < turned.max() <= np.sqrt(3)


def test_twins_by_texels_look_up_others(room):
    """In balls of the specification's radii; a point's texel is another one, its pixel hardly."""
    told = {"light_texels": 1.5, "light_radii": 0.05, "eye_pixels": 0.5}
    kind = replace(KIND, width=128, height=64, light_map={**PICTURE, "resolution": 256})
    setting = drawn(room, kind)
    light, eye = reach(room, kind, setting, told)
    surface = see_surface(room.at_rest, setting.camera, kind.width, kind.height)
    depth = np.median(np.linalg.norm(surface.p - setting.centre, axis=1))
    texel = 2 * np.tan(np.radians(60)) / 256
    assert light == pytest.approx(1.5 * depth * texel + 0.05 * 0.25, rel=0.03)
    depth = np.median(np.linalg.norm(surface.p - setting.camera.eye, axis=1))
    assert eye == pytest.approx(0.5 * depth * np.tan(np.radians(27.5)) / 32, rel=0.03)
    twins = [twin_of(room, kind, setting, told, np.random.default_rng(k)) for k in range(200)]
    for radius, moved in (
        (light, [twin.centre - setting.centre for twin in twins]),
        (eye, [twin.camera.eye - setting.camera.eye for twin in twins]),
    ):
        shares = np.linalg.norm(moved, axis=1) / radius
        assert shares.max() <= 1
        # Uniform in a ball: half of all are beyond the cube root of a half; no side is preferred.
        assert np.median(shares) == pytest.approx(0.5 ** (1 / 3), abs=0.05)
        assert np.abs(np.mean(moved, axis=0)).max() < 0.2 * radius
    views = [twin.camera.target - twin.camera.eye for twin in twins]
    assert np.allclose(views, setting.camera.target - setting.camera.eye)
    first, *others = (
        light_map_of(kind.light_map, room, one.centre, setting.centre).texels_of(
            surface.p - one.centre
        )
        for one in [setting, *twins]
    )
    assert np.mean([other != first for other in others]) > 0.6


@pytest.mark.parametrize("what", SEQUENCES)
def test_sequences_move_what_they_are_named_for(room, what):
    settings = draw_sequence(room, KIND, what, 5, np.random.default_rng(3))
    eyes, lights = (np.array(one) for one in zip(*((s.camera.eye, s.centre) for s in settings)))
    steps = [np.linalg.norm(np.diff(one, axis=0), axis=1) for one in (eyes, lights)]
    motions = np.array([s.motion for s in settings])
    moves = {"camera": (1, 0, 0), "light": (0, 1, 0), "both": (1, 1, 0), "object": (0, 0, 1)}[what]
    assert (steps[0].max() > 0, steps[1].max() > 0, np.ptp(motions, axis=0).max() > 0) == moves
    assert max(step.max() for step in steps) < 3 * STEP * room.at_rest.size
    turns = motions[:, :3, :3]
    assert np.allclose(turns @ turns.transpose(0, 2, 1), np.eye(3))


def test_the_shadow_of_an_object_is_seen_to_move_in_its_sequence(room):
    """Most windows of a large frame see nothing of it."""

    def changed(settings):
        lit = []
        for setting in (settings[0], settings[-1]):
            scene = room.moved(setting.motion)
            surface = see_surface(scene, setting.camera, WINDOW.width, WINDOW.height)
            lit.append(surface.image(lit_from(scene, surface, setting.centre), False))
        return np.mean(lit[0] != lit[1])

    for seed in range(3):
        settings = draw_sequence(room, WINDOW, "object", 5, np.random.default_rng(seed))
        assert changed(settings) > 0.5 * 4 * LEAST_CHANGE
        still = [replace(settings[0], motion=np.eye(4))] * 2
        assert why_still(room, WINDOW, still) == "no shadow of what moves is seen"


def test_where_the_mover_was(room):
    """Its points go back with it; those of all else stay."""
    settings = draw_sequence(room, KIND, "object", 3, np.random.default_rng(3))
    scene = room.moved(settings[2].motion)
    vertices, faces = scene.joined.vertices, scene.joined.faces
    centres = vertices[faces].mean(1)
    was = room.before(scene, np.arange(len(faces)), centres, *(s.motion for s in settings[2:0:-1]))
    earlier = room.moved(settings[1].motion).joined
    assert np.allclose(was, earlier.vertices[faces].mean(1), atol=1e-5)
    assert 0 < np.count_nonzero(np.linalg.norm(was - centres, axis=1) > 1e-4) < len(faces) / 4
