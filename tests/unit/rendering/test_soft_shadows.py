"""Soft shadows of a spherical light beside closed forms, and few rays beside many."""

import numpy as np
import pytest
import trimesh
from half_planes import CENTRE, down, half_plane, joined, share_seen, visible
from shapes import Y_UP, sheet

from neural_shadows.rendering.light_samples import (
    even_shifts,
    random_shifts,
    ring_shares,
    ring_vectors,
    sequence_run,
    spiral,
    spiral_shifts,
)
from neural_shadows.rendering.soft_shadows import soft_visibility
from neural_shadows.scenes.cameras import Camera


@pytest.mark.parametrize("height", [0.5, 1.5])
def test_half_plane_before_a_disc(height):
    radii = [0.1, 0.3]
    found, x = visible(radii, height=height)
    for radius, visibility in zip(radii, found):
        expected = share_seen(x, height, radius)
        assert expected.min() < 0.1 and expected.max() > 0.9
        assert np.abs(visibility - expected).max() < 0.04
        assert abs((visibility - expected).mean()) < 2e-3


def test_point_and_next_to_it():
    scene = joined(sheet(0.0, 30.0), half_plane(1.0))
    point, tiny = soft_visibility(
        scene, down(0.4, 0.3), 64, 8, centre=CENTRE, radii=[0, 1e-5], samples=2, adaptive=False
    )
    assert 0.2 < point.mean() < 0.8 and np.abs(point - tiny).max() < 0.13  # a place of eight
    assert np.mean(point != tiny) < 0.02


def test_light_below_the_ground_and_no_surface():
    scene = joined(sheet(0.0, 0.2))
    under = soft_visibility(
        scene, down(2.0, 0.4), 32, 32, centre=-CENTRE, radii=[0, 0.3], samples=2, adaptive=True
    )
    assert under[:, 16, 16].tolist() == [0, 0] and under[:, 0, 0].tolist() == [1, 1]


def forest(seed=0):
    """Boxes over a ground: umbrae, penumbrae of all widths, thin gaps."""
    rng = np.random.default_rng(seed)
    boxes = [sheet(0.0, 6.0)]
    for _ in range(60):
        shape = trimesh.creation.box(rng.uniform(0.02, 0.4, 3))
        shape.apply_translation([*rng.uniform(-1.5, 1.5, 2), 0])
        shape.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], Y_UP))
        shape.apply_translation([0, rng.uniform(0.2, 1.2), 0])
        boxes.append(shape)
    return joined(*boxes)


def test_few_rays_where_neighbours_agree():
    scene = forest()
    camera = Camera(np.array([2.5, 2.0, 2.5]), np.array([0, 0.2, 0]), Y_UP, 50.0)
    told = {"centre": np.array([0.5, 3.0, 0.3]), "radii": [0, 0.06, 0.12, 0.18, 0.25], "samples": 4}
    whole = soft_visibility(scene, camera, 128, 64, **told, adaptive=False)
    found = soft_visibility(scene, camera, 128, 64, **told)
    assert np.abs(found - whole).mean() < 5e-4
    # A larger light leaves less wholly dark, and nothing dark under it is lit under a smaller one.
    for small, large in zip(found[1:], found[2:]):
        assert np.all(small[large == 0] == 0) and (large == 0).sum() < (small == 0).sum()


def test_even_shifts_fill_the_square_evenly_within_any_block():
    """16 × 16 pixels' turns, and shares, are off equal steps by 0.02; independent ones by 0.05."""
    shifts = even_shifts(np.arange(64 * 64), 64).reshape(64, 64, 2)
    assert shifts.min() >= 0 and shifts.max() < 1
    for row, column in ((0, 0), (7, 30), (48, 48)):
        block = shifts[row : row + 16, column : column + 16].reshape(-1, 2)
        for shift in np.sort(block, axis=0).T:
            assert np.abs(shift - (np.arange(256) + 0.5) / 256).max() < 0.025
        assert abs(np.corrcoef(block.T)[0, 1]) < 0.1


def off_a_half_plane(*frames):
    """Squared error of frames' mean share of a disc beyond a line at any place and angle, × 10⁴."""
    count, rng = len(frames[0][1]), np.random.default_rng(3)
    angle, at = rng.uniform(0, 2 * np.pi, count), rng.uniform(-1, 1, count)
    across, shares = np.stack([np.cos(angle), np.sin(angle)], 1)[..., None], []
    for samples, shifts in frames:
        to_light = np.empty((count, samples.shape[1], 3), np.float32)
        light = CENTRE, np.array([1.0]), np.array([samples.shape[1]])
        ring_vectors(np.zeros((count, 3), np.float32), shifts, samples, *light, to_light)
        along = (to_light - CENTRE)[:, :, [0, 2]] @ across
        shares.append((along[..., 0] > at[:, None]).mean(1))
    exact = (np.arccos(at) - at * np.sqrt(1 - at**2)) / np.pi
    return 1e4 * np.mean(np.square(np.mean(shares, axis=0) - exact))


@pytest.mark.parametrize("frames", [1, 8])
def test_a_spiral_errs_less_from_three_samples_on(frames):
    """Also the mean of a sequence's frames, whose sets are elsewhere each."""
    shifts, errors = random_shifts(np.arange(20_000), 1), {}
    for count in (2, 3, 4, 8):
        run = [(sequence_run(k * count, count), shifts) for k in range(frames)]
        turned = [(spiral(count), spiral_shifts(shifts, k, count)) for k in range(frames)]
        assert all(each.max() < 1 for _, each in turned)
        errors[count] = off_a_half_plane(*run), off_a_half_plane(*turned)
    assert frames > 1 or errors[2][0] < errors[2][1]
    for count in (3, 4, 8):
        assert errors[count][1] < 0.9 * errors[count][0]


def test_rings_add_up_to_the_disc():
    radii = np.array([0.1, 0.2, 0.4])
    shares = ring_shares(radii)
    assert np.allclose(shares.sum(1), 1)
    assert np.allclose(shares[2], np.array([1, 3, 12]) / 16)
    points, count = np.zeros((1, 3), np.float32), np.full(3, 4096)
    to_light = np.empty((1, count.sum(), 3), np.float32)
    ring_vectors(
        points,
        random_shifts(np.array([7]), 3),
        sequence_run(0, 4096),
        CENTRE,
        radii,
        count,
        to_light,
    )
    away = (to_light[0] - CENTRE).astype(float)
    assert np.abs(away[:, 1]).max() < 1e-6  # across the way to the centre
    radius = np.hypot(away[:, 0], away[:, 2]).reshape(3, -1)
    edges = np.concatenate([[0], radii])
    for ring, (inner, outer) in zip(radius, zip(edges, edges[1:])):
        assert ring.min() >= inner - 1e-6 and ring.max() <= outer + 1e-6
        # Evenly by area: the squares are uniform between the edges'.
        shared = np.sort((ring**2 - inner**2) / (outer**2 - inner**2))
        assert np.abs(shared - (np.arange(4096) + 0.5) / 4096).max() < 0.005
    assert np.abs(away.mean(0)).max() < 1e-3
