"""What blocks the ways to a spherical light: how near to it, and how far from it."""

import numpy as np

from neural_shadows.rendering.light_samples import ring_ways
from neural_shadows.rendering.soft_shadows import OFFSET
from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.scene import Scene

RAYS = 16  # to the light, for the nearest and the farthest blocker


def blockers(
    scene: Scene, surface: Surface, chosen: np.ndarray, centre: np.ndarray, radius: float
) -> tuple[np.ndarray, np.ndarray]:
    """Distances from the light's centre of the nearest and the farthest of what the light first
    meets on 16 ways to each point, (n,); NaN where all ways are free.

    Args:
        chosen: (n,) int64, indices of the surface's points. centre, radius: of the light.
    """
    starts = np.take(surface.p, chosen, axis=0)
    starts += np.float32(OFFSET * scene.size) * np.take(surface.n_g, chosen, axis=0)
    ways = np.empty((len(starts), RAYS, 3), np.float32)
    counts = np.array([RAYS])
    ring_ways(starts, surface.pixel[chosen], 0, centre, np.array([radius]), counts, ways)
    ways = ways.reshape(-1, 3)
    on_light = np.repeat(starts, RAYS, axis=0) + ways
    share, _ = scene.tracer.first_hit(on_light, -ways)
    blocked = (share < 1 - 1e-3).reshape(-1, RAYS)
    place = on_light - np.minimum(share, 1)[:, None] * ways
    away = np.linalg.norm(place - centre, axis=1).reshape(-1, RAYS)
    nearest = np.where(blocked, away, np.inf).min(1)
    farthest = np.where(blocked, away, -np.inf).max(1)
    known = blocked.any(1)
    return np.where(known, nearest, np.nan), np.where(known, farthest, np.nan)


def solids_before(scene: Scene, surface: Surface, centre: np.ndarray) -> np.ndarray:
    """How many solids lie between each of a surface's points and the light's centre, (n,) int32.

    A solid has two surfaces, a sheet one: it is half the number of surfaces, rounded up. Those within
    1e-4 of the scene's size of each other count once. 0 where a point is turned from the light.

    Args:
        centre: (3,) of the light.
    """
    step = np.float32(OFFSET * scene.size)
    at = surface.p + step * surface.n_g
    way = centre.astype(np.float32) - at
    surfaces = np.zeros(len(at), np.int32)
    asked = np.flatnonzero(np.einsum("ij,ij->i", way, surface.n_g) > 0)
    at, way = at[asked], way[asked]
    while len(asked):
        share, _ = scene.tracer.first_hit(at, way)
        length = np.linalg.norm(way, axis=1)
        beyond = share * length + step  # of the surface that is hit, or ∞
        hit = beyond < length
        asked, at, way = asked[hit], at[hit], way[hit]
        surfaces[asked] += 1
        moved = (beyond[hit] / length[hit])[:, None] * way
        at, way = at + moved, way - moved
    return (surfaces + 1) // 2
