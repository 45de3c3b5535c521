"""Ray tracing with few rays a pixel: from its centre's point to points spread over the light."""

from collections.abc import Callable
from functools import partial

import numpy as np
from numba import njit

from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.light_samples import ring_ways
from neural_shadows.rendering.soft_shadows import PLACES

_RAYS = 1 << 16  # at once: 1.6 MB of them stay in a core's cache
_SALT = 1 << 26  # more than a frame's pixels

# Places in a pixel: of four a turned grid, of eight those of the targets.
_SPREAD = {
    2: ((0.25, 0.25), (0.75, 0.75)),
    4: ((0.375, 0.125), (0.875, 0.375), (0.125, 0.625), (0.625, 0.875)),
    8: PLACES,
}

Blocked = Callable[[np.ndarray, np.ndarray], np.ndarray]


def ray_traced(
    frame: SoftFrame,
    radius: float,
    *,
    samples: int,
    starts: np.ndarray | None = None,
    blocked: Blocked | None = None,
) -> np.ndarray:
    """The share of a pixel's rays that reach the light, (n,) float32, on one thread.

    The rays of a pixel go to a low-discrepancy set of its own, on the disc that the light is from
    there (`ring_ways`), so that pixels' errors are independent and 0 on average.

    Args:
        radius: of the light, in the scene's unit; 0 is a point, to which one ray goes.
        samples: rays of each pixel; in a sequence its next frame's go elsewhere.
        starts: of the rays, (n, 3) float32; without them the frame's.
        blocked: whether ways (m, 3) from points (m, 3) are blocked, (m,) bool; without it by the
            scene's triangles.
    """
    starts = frame.starts if starts is None else starts
    blocked, normals = blocked or frame.scene.tracer.blocked, frame.surface.n_g
    if radius == 0:
        ways = frame.centre.astype(np.float32) - starts
        return _shares(blocked, starts, ways[:, None], normals)
    # Other numbers than the exact shadow's, whose errors would be these rays' own.
    keys, drawn = frame.surface.pixel + _SALT, frame.number * samples
    radii, counts = np.array([radius], np.float64), np.array([samples], np.int64)
    size = max(1, _RAYS // samples)
    ways, origins = (np.empty((size, samples, 3), np.float32) for _ in range(2))
    found = np.empty(len(starts), np.float32)
    for begin in range(0, len(starts), size):
        part = slice(begin, begin + size)
        some = starts[part]
        there, here = ways[: len(some)], origins[: len(some)]
        ring_ways(some, keys[part], drawn, frame.centre, radii, counts, there)
        here[:] = some[:, None]
        found[part] = _shares(blocked, here, there, normals[part])
    return found


def _shares(blocked: Blocked, starts: np.ndarray, ways: np.ndarray, normals: np.ndarray):
    """Of each point's ways (n, samples, 3), how many are free: (n,) float32."""
    found = blocked(starts.reshape(-1, 3), ways.reshape(-1, 3))
    return _share_free(found.reshape(ways.shape[:2]), ways, normals)


@njit(cache=True, nogil=True)
def _share_free(blocked, ways, normals):
    """As the reference has it: what lies below the surface's own plane is not seen."""
    points, samples = blocked.shape
    found = np.empty(points, np.float32)
    for i in range(points):
        x, y, z = normals[i, 0], normals[i, 1], normals[i, 2]
        free = 0
        for k in range(samples):
            above = x * ways[i, k, 0] + y * ways[i, k, 1] + z * ways[i, k, 2] > 0
            free += above and not blocked[i, k]
        found[i] = free / samples
    return found


def spread(frame: SoftFrame, radius: float, *, samples: int) -> np.ndarray:
    """The same from as many places in each pixel, a ray from each: what a path tracer or a
    multisampled G-buffer sends. (n,) float32 of the frame's points.
    """
    images = [
        one.surface.image(ray_traced(one, radius, samples=1), 1.0)
        for one in frame.at_places(_SPREAD[samples])
    ]
    return np.mean(images, axis=0, dtype=np.float32).ravel()[frame.surface.pixel]


_BY_RAYS = {"texel_floats": 0, "by_rays": True}
METHODS = {
    f"rt_{count}": SoftMethod(partial(ray_traced, samples=count), **_BY_RAYS)
    for count in (1, 2, 4, 8, 16, 32, 40, 64)
} | {
    f"rt_{count}_spread": SoftMethod(partial(spread, samples=count), **_BY_RAYS)
    for count in _SPREAD
}
