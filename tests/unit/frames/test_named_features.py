"""Neural Shadow Mapping's features of frames whose values are known, and of what moves as a whole."""

import numpy as np
import pytest
from plate_frames import CENTRE, HEIGHT, WIDTH, camera, plate
from scipy.spatial.transform import Rotation

from neural_shadows.errors import InputError
from neural_shadows.frames.buffers import CHANNELS, buffers_of
from neural_shadows.frames.feature_names import FEATURES, NSM_FEATURES
from neural_shadows.frames.features import DIFFERENCE_SCALE, RATIO_SCALE, named_features
from neural_shadows.frames.light_size import LightSize
from neural_shadows.meshes.prepared_mesh import with_normals
from neural_shadows.rendering.gbuffer import Lens, axis_cosines, lens_of
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.cameras import Camera, Window
from neural_shadows.scenes.scene import make_scene
from neural_shadows.shadow_maps.light_map import perspective_map

DOWN = np.array([0.0, -1.0, 0.0])
MAIN = ("c_e", "view", "ratio", "difference")
HEAD_ON, LIGHT = Lens(np.float32(1), 100.0), LightSize(1.0, 0.0)
AWAY = Camera(np.array([0.0, 0.5, 1.9]), np.array([0.0, 0.6, 0.0]), UP, 50.0)  # half of it is sky


def rendered(scene, view, centre):
    """Buffers by name and the surface."""
    surface = see_surface(scene, view, WIDTH, HEIGHT)
    found = buffers_of(scene, surface, perspective_map(centre, DOWN, 100, 256))
    return dict(zip(CHANNELS, found.astype(np.float32))), surface


def by_name(names, buffers, view, step=2.0):
    found = named_features(names, buffers, lens_of(view, WIDTH, HEIGHT), LightSize(step, 0.0))
    ends = np.cumsum([FEATURES[name] for name in names])[:-1]
    images = dict(zip(names, (np.squeeze(one) for one in np.split(found, ends))))
    for name, scale, centre in (("ratio", RATIO_SCALE, 1), ("difference", DIFFERENCE_SCALE, 0)):
        if name in images:  # as the paper has them
            log = images[name]
            images[name] = centre + np.sign(log) * np.expm1(np.abs(log)) / scale
    return images


def test_lit_ground():
    """What the light sees is the point itself, but for a texel's slope."""
    buffers, surface = rendered(plate(), camera(), CENTRE)
    found, lit = by_name(tuple(NSM_FEATURES), buffers, camera()), buffers["hard"] == 1
    size, p = plate().size, surface.image(surface.p)
    z_f = np.linalg.norm(p - CENTRE, axis=-1) / size
    assert np.allclose(found["ratio"][lit], 1, atol=0.01)
    assert np.allclose(found["difference"][lit], 0, atol=0.01)
    assert np.allclose(found["z"][lit], z_f[lit], atol=0.01)
    assert np.allclose(found["z_f"], z_f, rtol=2e-3)
    assert np.allclose(found["n_e"][:, lit], [[0], [1], [0]], atol=1e-3)
    assert np.allclose(found["d"], surface.depth_image() / size, rtol=2e-3)
    assert np.allclose(found["view"] * found["d"], buffers["c_v"], atol=2e-3)
    # Under the ball the map shows it, which is nearer to the light.
    dark = ~lit
    assert found["difference"][dark].max() < -0.2 and found["ratio"][dark].max() < 0.75


@pytest.mark.parametrize("step", [0, 1, 2, 3, 4])
def test_a_whole_step_can_be_read_from_the_first_channel(step):
    buffers = {"c_e": np.random.default_rng(0).uniform(-1, 1, (4, 6)).astype(np.float32)}
    (first,) = named_features(("c_e",), buffers, HEAD_ON, LightSize(step, 0.0))
    assert np.all(np.floor(np.minimum(5 * first, step + 0.999)) == step)


def test_a_pixel_without_a_surface_has_the_step_alone():
    buffers, surface = rendered(plate(), AWAY, CENTRE)
    found, sky = by_name(tuple(NSM_FEATURES), buffers, AWAY), ~surface.image(surface.p[:, 0] < 9)
    assert 0.1 < sky.mean() < 0.9
    assert np.all(found.pop("c_e")[sky] == np.float32(2 / 5))
    found["ratio"] -= 1  # there is no distance to be in proportion to
    assert not any(one[..., sky].any() for one in found.values())


def test_a_motion_of_all_turns_normals_and_nothing_else():
    """By 90 degrees, so that the map's texels lie as they did."""
    turn, shift = Rotation.from_euler("y", 90, degrees=True), np.array([0.3, 0.1, -0.2])
    meshes = [
        with_normals((turn.apply(mesh.vertices) + shift).astype(np.float32), mesh.faces)
        for mesh in plate().objects
    ]
    scene = make_scene(*meshes, up=UP, ground=False, light=None)
    eye, target = (turn.apply(one) + shift for one in (AWAY.eye, AWAY.target))
    view = Camera(eye, target, AWAY.up, AWAY.fov)
    before = by_name(tuple(NSM_FEATURES), rendered(plate(), AWAY, CENTRE)[0], AWAY)
    after = by_name(tuple(NSM_FEATURES), rendered(scene, view, turn.apply(CENTRE) + shift)[0], view)
    for name in ("n", "n_e"):
        before[name] = np.moveaxis(
            turn.apply(np.moveaxis(before[name], 0, -1).reshape(-1, 3)), 0, 1
        )
        before[name] = before[name].reshape(after[name].shape)
    for name in NSM_FEATURES:  # roundings decide a texel here and there
        assert np.mean(np.abs(after[name] - before[name]) > 4e-3) < 0.01, name


def test_a_window_has_its_frames_cosines():
    whole = Camera(np.zeros(3), -DOWN + [1, 0, 0], UP, 55.0)
    part = Camera(whole.eye, whole.target, UP, 55.0, Window(40, 20, 30, 5))
    assert np.allclose(axis_cosines(part, 8, 6), axis_cosines(whole, 40, 20)[5:11, 30:38])
    row = Camera(whole.eye, whole.target, UP, 55.0, Window(40, 21, 0, 10))  # its middle one
    across = 19.5 / row.focal(1)  # of the last pixel's centre, at depth 1
    assert axis_cosines(row, 40, 1)[0, -1] == pytest.approx(1 / np.hypot(1, across))


def test_what_is_lacking_is_named():
    one = np.ones((2, 2), np.float32)
    with pytest.raises(InputError, match="'colour' is not a feature. Use c_e, view"):
        named_features((*MAIN[:1], "colour"), {"c_e": one}, HEAD_ON, LIGHT)
    with pytest.raises(InputError, match="the features n_e need the buffer e_y, e_z"):
        named_features(("n_e",), {"e_x": one}, HEAD_ON, LIGHT)
