"""What lies between points and a light, of solids whose places are known."""

import numpy as np
import trimesh
from shapes import box, scene_of, sheet

from neural_shadows.rendering.blockers import blockers, solids_before
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.cameras import Camera

HIGH = np.array([0.0, 1000.0, 0.0])  # a light with upright rays, to a thousandth


def moved(shape, *way):
    shape.apply_translation(way)
    return shape


def seen(*shapes):
    """A ground of 6 m under shapes, and what a camera below these sees of it."""
    shape = trimesh.util.concatenate([sheet(0, 3.0), *shapes])
    scene = scene_of(shape, ground=False, light=None)
    camera = Camera(np.array([0, 0.8, 0.001]), np.zeros(3), np.array([0, 0, -1.0]), 120.0)
    return scene, see_surface(scene, camera, 64, 64)


def test_solids_and_sheets_on_the_way_are_counted():
    """A box over x < 0 with a second over its half, a sheet over z > 0; nothing over the rest."""
    low, high = moved(box(3, 0.5, 6), -1.5, 1.5, 0), moved(box(1, 0.5, 6), -1.5, 3, 0)
    roof = moved(sheet(0, 3.0), 0, 5, 3)
    scene, surface = seen(low, high, roof)
    x, _, z = surface.p.T
    boxes = 1 * (x < 0) + (np.abs(x + 1.5) < 0.5)
    expected = (2 * boxes + (z > 0) + 1) // 2  # two surfaces of a box, one of the sheet
    far = np.min([np.abs(x), np.abs(np.abs(x + 1.5) - 0.5), np.abs(z)], axis=0) > 0.02
    found = solids_before(scene, surface, HIGH)
    assert far.mean() > 0.8 and np.array_equal(found[far], expected[far])
    assert set(expected[far]) == {0, 1, 2, 3}


def test_none_is_before_what_is_turned_from_the_light():
    scene, surface = seen(moved(box(3, 0.5, 6), -1.5, 1.5, 0))
    assert not solids_before(scene, surface, -HIGH).any()


def test_what_lies_beyond_the_light_does_not_count():
    scene, surface = seen(moved(box(6, 0.5, 6), 0, 1.5, 0))
    assert not solids_before(scene, surface, np.array([0.0, 1.0, 0.0])).any()


def test_a_bare_floor_is_no_blocker_of_a_light_that_reaches_below_it():
    scene, surface = seen()
    chosen = np.arange(0, len(surface.p), 7)
    for height in (0.5, 0.1, 0.05):
        both = blockers(scene, surface, chosen, np.array([0.0, height, 0.0]), 0.25)
        assert np.isnan(both).all()
