"""Widths of penumbrae: of discs whose edges have every direction, and of a box's exact shadow."""

import numpy as np
import pytest

from neural_shadows.meshes.prepared_mesh import with_normals
from neural_shadows.metrics.kinds.penumbra_width import (
    WIDEST,
    local_widths,
    penumbra_width,
)
from neural_shadows.rendering.soft_shadows import soft_visibility
from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.pieces.building import floor
from neural_shadows.scenes.pieces.shapes import box
from neural_shadows.scenes.scene import make_scene

SIDE, RADIUS = 400, 120.0
PLACES = np.hypot(*(np.indices((SIDE, SIDE)) + 0.5 - SIDE / 2))
HARD = (PLACES > RADIUS).astype(np.float32)
VALID = np.ones((SIDE, SIDE), bool)


@pytest.mark.parametrize("width", [10.0, 40.0])
def test_a_round_shadow_s_penumbra_is_as_wide_as_it_was_made(width):
    soft = np.clip(0.5 + (PLACES - RADIUS) / width, 0, 1)
    assert penumbra_width(soft, VALID, HARD) == pytest.approx(width, rel=0.03)


def test_only_what_counts_is_measured():
    soft = np.clip(0.5 + (PLACES - RADIUS) / 20, 0, 1)
    half = VALID & (np.arange(SIDE) < SIDE // 2)
    soft[~half] = 0.5
    assert penumbra_width(soft, half, HARD) == pytest.approx(20, rel=0.03)
    assert penumbra_width(HARD, VALID, HARD) == 0
    assert np.isnan(penumbra_width(soft, VALID, np.ones_like(HARD)))


NOWHERE = np.zeros_like(VALID)


def hidden(x, width):
    """Visibility of a spherical light across a straight edge's penumbra: a disc's segment."""
    t = np.clip(2 * x / width, -1, 1)
    return 0.5 + (np.arcsin(t) + t * np.sqrt(1 - t**2)) / np.pi


@pytest.mark.parametrize("rays", [None, 512])
@pytest.mark.parametrize("width", [5.0, 8.0, 12.0, 20.0, 30.0, 45.0, 60.0, 90.0])
def test_widths_pixel_by_pixel(width, rays):
    soft = hidden(PLACES - RADIUS, width)
    if rays is not None:  # as those of a target: of each ray hidden or not
        soft = np.random.default_rng(0).binomial(rays, soft) / rays
    low, middle, high = np.percentile(local_widths(soft, VALID, NOWHERE), [10, 50, 90])
    assert middle == pytest.approx(width, rel=0.08 if rays else 0.05, abs=1.0)
    assert high - low < 0.15 * width + 0.5


def test_each_penumbra_has_its_own_width():
    """A wide one in one half of the picture, a narrow one in the other: the mean has neither."""
    wide, narrow = (np.tile(hidden(np.arange(SIDE) - 200, w), (200, 1)) for w in (50, 8))
    soft = np.vstack([wide, narrow])
    assert np.median(local_widths(soft, VALID, NOWHERE)) == pytest.approx(50, rel=0.1)
    top, bottom = (np.arange(SIDE)[:, None] < 140) & VALID, (np.arange(SIDE)[:, None] > 260) & VALID
    assert np.percentile(local_widths(soft, bottom, NOWHERE), 90) == pytest.approx(8, rel=0.1)
    assert np.percentile(local_widths(soft, top, NOWHERE), 50) == pytest.approx(50, rel=0.1)


def test_an_edge_of_the_geometry_is_no_penumbra():
    soft = hidden(np.tile(np.arange(SIDE) - 150.0, (SIDE, 1)), 40)
    soft[:, 160:] = 0  # a wall that is dark
    edges = np.zeros_like(VALID)
    edges[:, 157:163] = True
    assert np.percentile(local_widths(soft, VALID, NOWHERE), 50) < 12
    assert np.percentile(local_widths(soft, VALID, edges), 50) == pytest.approx(40, rel=0.1)


def test_without_a_penumbra_there_is_no_width():
    assert local_widths(HARD, VALID, NOWHERE).size == 0
    flat = np.full_like(HARD, 0.5)
    assert np.percentile(local_widths(flat, VALID, NOWHERE), 50) == WIDEST


def test_the_exact_shadow_of_an_edge_is_as_wide_as_geometry_has_it():
    """Under a box's straight edge: twice the radius times (z − z_b) / z_b, seen from 1.1 m above."""
    radius, light, edge, eye, side = 0.1, 2.4, 1.2, 1.1, 200
    shapes = floor(6, 6), box((-3, edge, -3), (0, edge + 0.01, 3))
    meshes = [with_normals(np.float32(s.vertices), np.int32(s.faces)) for s in shapes]
    scene = make_scene(*meshes, up=UP, ground=False, light=None)
    ahead = np.array([0.0, 0.0, -1.0])
    camera = Camera(np.array([0.0, eye, 0.0]), np.zeros(3), ahead, 60.0)
    centre = np.array([0.0, light, 0.0])
    (soft,) = soft_visibility(scene, camera, side, side, centre=centre, radii=[radius], samples=16)
    expected = 2 * radius * (light - edge) / edge / eye * camera.focal(side)
    widths = local_widths(soft, np.ones_like(soft, bool), np.zeros_like(soft, bool))
    assert expected == pytest.approx(31.5, abs=0.1)
    assert np.median(widths) == pytest.approx(expected, rel=0.06)
    assert np.percentile(widths, 90) == pytest.approx(expected, rel=0.1)
