"""Distances and numbers of blockers of an area light."""

import numpy as np

from neural_shadows.rendering.light_samples import random_shifts, sequence_run
from neural_shadows.rendering.light_shape import SPHERE, LightShape
from neural_shadows.rendering.soft_shadows import OFFSET
from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.scene import Scene

RAYS = 16  # to the light, for the nearest and the farthest blocker


def blockers(
    scene: Scene,
    surface: Surface,
    chosen: np.ndarray,
    centre: np.ndarray,
    radius: float,
    shape: LightShape = SPHERE,
) -> tuple[np.ndarray, np.ndarray]:
    """Distances of the nearest and the farthest blocker by 16 rays, (n,).

    From the light's centre to the first hits from the light; NaN without blockers.

    Args:
        chosen: (n,) int64, indices of the surface's points. centre, radius, shape: of the light.
    """
    starts = np.take(surface.p, chosen, axis=0)
    starts += np.float32(OFFSET * scene.size) * np.take(surface.n_g, chosen, axis=0)
    to_light = np.empty((len(starts), RAYS, 3), np.float32)
    counts = np.array([RAYS])
    shifts = random_shifts(surface.pixel[chosen], 1)
    samples = sequence_run(0, RAYS)
    shape.ring_vectors(starts, shifts, samples, centre, np.array([radius]), counts, to_light)
    # As in the reference, only above the surface's plane: below it a ray meets the surface itself.
    above = np.einsum("ijk,ik->ij", to_light, surface.n_g[chosen]) > 0
    to_light = to_light.reshape(-1, 3)
    on_light = np.repeat(starts, RAYS, axis=0) + to_light
    share, _ = scene.tracer.first_hit(on_light, -to_light)
    # Of the distance, but of a sun's that in the scene.
    ignored = 1e-3 * min(1.0, 4 * scene.size / np.linalg.norm(centre - scene.ball[0]))
    blocked = (share < np.float32(1 - ignored)).reshape(-1, RAYS) & above
    hits = on_light - np.minimum(share, 1)[:, None] * to_light
    distances = np.linalg.norm(hits - centre, axis=1).reshape(-1, RAYS)
    nearest = np.where(blocked, distances, np.inf).min(1)
    farthest = np.where(blocked, distances, -np.inf).max(1)
    any_blocked = blocked.any(1)
    return np.where(any_blocked, nearest, np.nan), np.where(any_blocked, farthest, np.nan)


def solids_before(scene: Scene, surface: Surface, centre: np.ndarray) -> np.ndarray:
    """Count the solids between points and the light's centre, (n,) int32.

    A solid has two surfaces, a sheet one: it is half the number of surfaces, rounded up. Those within
    1e-4 of the scene's size of each other count once. 0 for a point turned from the light.

    Args:
        centre: (3,) of the light.
    """
    step = np.float32(OFFSET * scene.size)
    points = surface.p + step * surface.n_g
    remaining = centre.astype(np.float32) - points
    surfaces = np.zeros(len(points), np.int32)
    indices = np.flatnonzero(np.einsum("ij,ij->i", remaining, surface.n_g) > 0)
    points, remaining = points[indices], remaining[indices]
    while len(indices):
        share, _ = scene.tracer.first_hit(points, remaining)
        length = np.linalg.norm(remaining, axis=1)
        offsets = share * length + step  # the hit surface, or ∞
        hit = offsets < length
        indices, points, remaining = indices[hit], points[hit], remaining[hit]
        surfaces[indices] += 1
        moved = (offsets[hit] / length[hit])[:, None] * remaining
        points, remaining = points + moved, remaining - moved
    return (surfaces + 1) // 2
