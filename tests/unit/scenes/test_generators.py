"""Generated scenes: what they promise of their seeds, sizes and places."""

from functools import cache

import numpy as np
import pytest
import trimesh
from placed_objects import check_objects

from neural_shadows.errors import InputError
from neural_shadows.meshes.prepared_mesh import with_normals
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.arrangement import UP, scene_of
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.generated import arrange, generator_module, generator_names
from neural_shadows.scenes.generators.plate import arrange_plate

BARE = {"plate", "stage"}  # an inserted object is all that they have
NAMES = [name for name in generator_names() if name not in BARE]
BALL = trimesh.creation.icosphere(2)
# Evenly over the sphere, by the golden angle.
_HEIGHTS = (2 * np.arange(256) + 1) / 256 - 1
_ANGLES = np.pi * (1 + 5**0.5) * np.arange(256)
_ACROSS = np.sqrt(1 - _HEIGHTS**2)
AROUND = np.stack([_ACROSS * np.cos(_ANGLES), _HEIGHTS, _ACROSS * np.sin(_ANGLES)], axis=1)

made = cache(arrange)


@cache
def scene(name):
    return scene_of(made(name, 1))


def clearances(scene, points):
    """How far anything is from each point, (n,), along 256 directions."""
    origins = np.repeat(points, len(AROUND), axis=0).astype(np.float32)
    ways = np.tile(AROUND, (len(points), 1)).astype(np.float32)
    return scene.tracer.first_hit(origins, ways)[0].reshape(len(points), -1).min(1)


@pytest.mark.parametrize("name", NAMES)
def test_seeds_sizes_and_floor(name):
    first, again, other = made(name, 1), arrange(name, 1), made(name, 2)
    assert [a.vertices.tobytes() for a in first.objects] == [
        b.vertices.tobytes() for b in again.objects
    ]
    assert any(
        a.vertices.tobytes() != b.vertices.tobytes() for a, b in zip(first.objects, other.objects)
    )
    for drawn in (first, other):
        assert 10_000 <= sum(len(part.faces) for part in drawn.objects) <= 60_000
        check_objects(drawn)


@pytest.mark.parametrize("name", NAMES)
def test_lights_cameras_and_spots_are_free(name):
    drawn, rng = made(name, 1), np.random.default_rng(5)
    lights = np.array([drawn.lights.draw(rng) for _ in range(64)])
    assert clearances(scene(name), lights).min() > 0.28
    eyes = np.array([drawn.cameras.draw(rng) for _ in range(64)])
    assert np.mean(clearances(scene(name), eyes) > 0.2) >= 0.9
    for spot in drawn.spots:
        middle = spot.position + [0, spot.height / 2, 0]
        assert clearances(scene(name), middle[None])[0] > 0.45 * spot.height, spot.position


@pytest.mark.parametrize("name", NAMES)
def test_frames_are_neither_dark_nor_without_shadow(name):
    drawn, rng, shares = made(name, 1), np.random.default_rng(6), []
    for _ in range(16):
        eye, target = drawn.cameras.draw(rng), drawn.targets.draw(rng)
        surface = see_surface(scene(name), Camera(eye, target, UP, 60.0), 64, 32)
        if not len(surface.p):
            shares.append(0.0)
            continue
        ways = drawn.lights.draw(rng).astype(np.float32) - surface.p
        facing = np.einsum("ij,ij->i", surface.n_g, ways) > 0
        free = ~scene(name).tracer.blocked(surface.p + np.float32(1e-3) * surface.n_g, ways)
        shares.append(np.mean(facing & free))
    shares = np.array(shares)
    assert np.mean((shares > 0.05) & (shares < 0.95)) >= 0.5, shares.round(2)


@pytest.mark.parametrize("name", NAMES)
def test_inserted_objects_stand_on_their_spots(name):
    drawn, ball = made(name, 1), with_normals(BALL.vertices, BALL.faces)
    balls = {f"ball {k}": ball for k in range(len(drawn.spots))}
    whole = scene_of(drawn, balls)
    for spot, mesh in zip(drawn.spots, whole.objects[len(drawn.objects) :], strict=True):
        low, high = mesh.vertices.min(0), mesh.vertices.max(0)
        np.testing.assert_allclose(low[1], spot.position[1], atol=1e-5)
        assert 0.99 * spot.height < high[1] - low[1] < 1.001 * spot.height
        np.testing.assert_allclose((low + high)[[0, 2]] / 2, spot.position[[0, 2]], atol=1e-5)
        # Straight under it is what it stands on.
        foot = (spot.position + [0, 0.01, 0]).astype(np.float32)[None]
        t, _ = scene(name).tracer.first_hit(foot, np.array([[0, -1, 0]], np.float32))
        assert abs(t[0] - 0.01) < 2e-3, spot.position
    with pytest.raises(InputError, match=f"{name}: .* but {len(balls)} spots"):
        scene_of(drawn, balls | {"one more": ball})


@pytest.mark.parametrize("name", NAMES)
def test_a_motion_moves_only_the_mover(name):
    drawn, motion = made(name, 1), np.eye(4)
    motion[:3, 3] = [0.1, 0.2, -0.3]
    moved = scene_of(drawn, moved=motion)
    for part, before, after in zip(drawn.objects, scene(name).objects, moved.objects, strict=True):
        by = motion[:3, 3] if part.name == drawn.mover else 0
        np.testing.assert_allclose(after.vertices, before.vertices + by, atol=1e-5)


def test_scenes_by_name():
    assert all(generator_module(name).is_file() for name in NAMES)


@pytest.mark.parametrize("height", [0.0, 1.4])
def test_the_plate_holds_an_object_at_its_height(height):
    ball = with_normals(BALL.vertices, BALL.faces)
    ground, above = scene_of(arrange_plate(height), {"ball": ball}).objects
    assert np.ptp(ground.vertices, axis=0).tolist() == [4, 0, 4]
    np.testing.assert_allclose(above.vertices[:, 1].min(), height, atol=1e-6)
    np.testing.assert_allclose(np.ptp(above.vertices, axis=0)[1], 0.4, atol=4e-3)


def test_the_stage_shows_its_object_from_all_sides():
    ball = with_normals(BALL.vertices, BALL.faces)
    drawn, rng = made("stage", 1), np.random.default_rng(7)
    whole = scene_of(drawn, {"ball": ball})
    assert np.ptp(whole.objects[1].vertices, axis=0)[1] == pytest.approx(1, rel=0.01)
    eyes = np.array([drawn.cameras.draw(rng) for _ in range(32)])
    assert clearances(whole, eyes).min() > 0.4 and clearances(whole, eyes).max() < 2.5
    assert (np.ptp(np.sign(eyes[:, [0, 2]]), axis=0) == 2).all()
    for eye in eyes:
        surface = see_surface(whole, Camera(eye, drawn.targets.draw(rng), UP, 55.0), 64, 32)
        assert 0.05 < np.mean(whole.owner[surface.face] == 1) < 0.7
        assert len(surface.p) > 0.5 * 64 * 32  # of sky and ground most is ground
