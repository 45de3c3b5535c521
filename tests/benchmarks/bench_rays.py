"""Rays against triangles, in packets as the pipeline sends them, beside embreex's single rays.

Of one frame of a room, on one thread: shadow rays to lights of three sizes and to a parallel one,
first hits of the camera's rays, and rays that have nothing in common.
"""

import numpy as np
from measurement import Row, median_seconds

from neural_shadows.frames.draw_settings import FrameKind, draw_setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.light_samples import ring_vectors
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.embree_packets import EmbreePackets
from neural_shadows.scenes.tracing import NEARLY_ALL, EmbreeSingly

SCENE = {"generate": "room", "seed": 2026, "inserted": {}}
RADII = (0.0625, 0.25, 1.0)  # of the lights, metres
SAMPLES = (1, 4, 16)  # rays of a pixel
PACKETS, SINGLE = "packets", "embreex's single rays"


def rows(quick: bool) -> list[Row]:
    """Rays a second by both; their answers are the same, or it stops."""
    scene = SoftScene(SCENE, [])
    kind = FrameKind(512, 256, 55, None, {"kind": "perspective", "fov": 120, "resolution": 512}, 1)
    setting = draw_setting(scene, kind, np.random.default_rng(2))
    mesh, rest = scene.at_rest.joined, scene.at_rest
    surface = see_surface(rest, setting.camera, kind.width, kind.height)
    starts = surface.p + np.float32(1e-4 * rest.size) * surface.n_g
    packets, singly = (form(mesh.vertices, mesh.faces) for form in (EmbreePackets, EmbreeSingly))
    rounds, found = 2 if quick else 5, []

    def add(stage: str, query: str, points: np.ndarray, ways: np.ndarray, *end: float) -> None:
        works = {
            name: lambda rays=rays: getattr(rays, query)(points, ways, *end)
            for name, rays in ((PACKETS, packets), (SINGLE, singly))
        }
        for ours, theirs in zip(*(np.atleast_2d(work()) for work in works.values())):
            assert np.array_equal(ours, theirs)
        rate = {name: len(points) / value for name, value in median_seconds(works, rounds).items()}
        found.append(Row(stage, "cpu x1", rate[PACKETS], "rays/s", None, SINGLE, rate[SINGLE]))

    for radius in RADII:
        for samples in SAMPLES:
            ways = np.empty((len(starts), samples, 3), np.float32)
            light = setting.centre, np.array([radius]), np.array([samples])
            ring_vectors(starts, surface.pixel, 0, *light, ways)
            points = np.repeat(starts, samples, axis=0)
            stage = f"shadow rays, light of {radius} m, {samples} a pixel"
            add(stage, "occluded", points, ways.reshape(-1, 3), NEARLY_ALL)
    add(
        "shadow rays, parallel",
        "occluded",
        starts,
        np.tile(np.float32([[1, 3, 2]]), (len(starts), 1)),
    )
    eye = np.broadcast_to(setting.camera.eye.astype(np.float32), starts.shape).copy()
    add("first hits of the camera's rays", "first_hit", eye, surface.p - eye)
    mixed = starts[np.random.default_rng(0).permutation(len(starts))]
    add("rays from any point to any other", "occluded", starts, mixed - starts, NEARLY_ALL)
    return found
