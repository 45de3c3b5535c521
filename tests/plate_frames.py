"""Frames of the `plate` scene: the soft shadow of a ball on a ground, and nothing else in sight."""

from functools import cache

import numpy as np
import trimesh
from shapes import prepared

from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.light_shape import SPHERE
from neural_shadows.rendering.soft_shadows import soft_visibility
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.arrangement import UP, scene_of
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.generators.plate import arrange_plate
from neural_shadows.shadow_maps.light_map import cube_map

CENTRE = np.array([0.0, 3.0, 0.0])
RADIUS = 0.2  # metres: about as large as the ball, which stands 0.8 above the ground
WIDTH, HEIGHT = 128, 64


@cache
def plate():
    ball, _ = prepared(trimesh.creation.icosphere(3))
    return scene_of(arrange_plate(0.8), {"ball": ball})


def camera(shift=0.0):
    """Under the ball, so that no pixel has an edge in it; pixels' depths are within 2 % of the next."""
    return Camera(np.array([shift, 0.75, 0.6]), np.array([shift, 0, 0]), UP, 30.0)


def plate_frame(shift=0.0, shape=SPHERE):
    surface = see_surface(plate(), camera(shift), WIDTH, HEIGHT)
    return SoftFrame(plate(), surface, CENTRE, cube_map(CENTRE, 8), shape=shape)


@cache
def plate_truth(shift=0.0, shape=SPHERE):
    """Its visibility, (HEIGHT · WIDTH,) float32."""
    light = {"centre": CENTRE, "radii": [RADIUS], "shape": shape}
    size = WIDTH, HEIGHT
    images = soft_visibility(plate(), camera(shift), *size, **light, samples=32, adaptive=False)
    return images[0].ravel()


def error(found, truth):
    """Mean squared."""
    return float(np.mean(np.square(found.ravel() - truth, dtype=np.float64)))
