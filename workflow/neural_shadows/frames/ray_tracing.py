"""Few rays a pixel, from its centre to the light."""

from collections.abc import Callable, Iterator

import numpy as np
from numba import njit

from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.light_samples import (
    even_shifts,
    random_shifts,
    sequence_run,
    spiral,
    spiral_shifts,
)
from neural_shadows.rendering.soft_shadows import PLACES, free_shares
from neural_shadows.scenes.tracing import NEARLY_ALL

_CHUNK = 1 << 16  # at once: 1.6 MB of them stay in a core's cache
_SALT = 1 << 26  # more than a frame's pixels

# Rays of a pixel from which on they are a spiral. Two alone err by 6 to 9 % more so; filtered, spread among
# neighbours, by up to 7 % less (FFX-, SVGF-like and `kernels_rays`, squared, seven scenes, four lights).
_FEWEST_OF_SPIRAL, _FEWEST_OF_EVEN = 3, 2

# Positions in a pixel: four of a rotated grid, eight of the targets' turned by a quarter. With the targets' own
# a point light's shadow would be the target itself.
_SPREAD = {
    2: ((0.25, 0.25), (0.75, 0.75)),
    4: ((0.375, 0.125), (0.875, 0.375), (0.125, 0.625), (0.625, 0.875)),
    8: tuple((y, 1 - x) for x, y in PLACES),
}

Blocked = Callable[[np.ndarray, np.ndarray], np.ndarray]


def ray_traced(
    frame: SoftFrame,
    radius: float,
    *,
    samples: int,
    starts: np.ndarray | None = None,
    blocked: Blocked | None = None,
    even: bool = False,
) -> np.ndarray:
    """Share of a pixel's unblocked rays, (n,) float32.

    On one thread. The rays of a pixel go to a low-discrepancy set of its own on the light, as of a
    sphere on the disc that it is from there.

    Args:
        radius: of the light, in the scene's unit; 0 is a point, to which one ray goes.
        samples: rays of each pixel; in a sequence its next frame's go elsewhere.
        starts: of the rays, (n, 3) float32; without them the frame's.
        blocked: of points (m, 3) and vectors (m, 3) from them to the light, the mask of blocked rays,
            (m,) bool; without it by the scene's triangles.
        even: neighbours' rays are spread evenly over the light, as filters and networks are fed; else
            pixels' errors are independent.
    """
    starts = frame.starts if starts is None else starts
    blocked, normals = blocked or frame.scene.tracer.blocked, frame.surface.n_g
    if radius == 0:
        to_light = frame.centre.astype(np.float32) - starts
        return _shares(blocked, starts, to_light[:, None], normals)
    visibility = np.empty(len(starts), np.float32)
    for part, origins, to_light in _rays(frame, radius, samples, starts, even):
        visibility[part] = _shares(blocked, origins, to_light, normals[part])
    return visibility


def ray_traced_penumbrae(
    frame: SoftFrame, radius: float, *, samples: int, even: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Share of free rays by first hits, and penumbrae's radii.

    Distances took 1.2 times as long as occlusion tests.

    Args:
        radius, samples, even: see `ray_traced`; the radius is above 0.

    Returns:
        visibility (n,) float32, and the mean radius of the penumbrae of a pixel's blockers, (n,)
        float32 in the scene's unit, −1 without any: a blocker of a ray of length 1 at t blurs the light's edge by radius · t / (1 − t).
    """
    starts, normals, tracer = frame.starts, frame.surface.n_g, frame.scene.tracer
    visibility, penumbra = np.empty((2, len(starts)), np.float32)
    for part, origins, to_light in _rays(frame, radius, samples, starts, even):
        free = tracer.free_shares(origins.reshape(-1, 3), to_light.reshape(-1, 3))
        free = free.reshape(to_light.shape[:2])
        blocked = free < np.float32(NEARLY_ALL)
        visibility[part] = free_shares(blocked, to_light, normals[part])
        penumbra[part] = _mean_penumbra(blocked, free, to_light, normals[part], radius)
    return visibility, penumbra


def traced_images(
    frame: SoftFrame, radius: float, *, samples: int
) -> tuple[np.ndarray, np.ndarray]:
    """Images (height, width) float32 of rays: the share of free ones, and penumbrae's radii.

    Lit, and −1, where there is no surface; the radii in shares of the scene's size, −1 without a
    blocker, and of a point light.

    Args:
        radius, samples: see `ray_traced`.
    """
    surface = frame.surface
    if radius == 0:
        visibility = surface.image(ray_traced(frame, radius, samples=1), 1.0)
        return visibility, np.full_like(visibility, -1)
    visibility, penumbra = ray_traced_penumbrae(frame, radius, samples=samples, even=True)
    penumbra = np.where(penumbra < 0, -1, penumbra / np.float32(frame.scene.size))
    return surface.image(visibility, 1.0), surface.image(penumbra.astype(np.float32), -1.0)


def _rays(
    frame: SoftFrame, radius: float, samples: int, starts: np.ndarray, even: bool
) -> Iterator[tuple[slice, np.ndarray, np.ndarray]]:
    """Slices of the points, rays' origins, vectors to the light.

    (part, samples, 3) each, overwritten by those of the next part.
    """
    if even:
        shifts = even_shifts(frame.surface.pixel, frame.surface.width)
    else:  # other random numbers than the exact shadow's, to keep errors independent
        shifts = random_shifts(frame.surface.pixel + _SALT, 1)
    if samples < (_FEWEST_OF_EVEN if even else _FEWEST_OF_SPIRAL):
        on_light = sequence_run(frame.number * samples, samples)
    else:
        on_light = spiral(samples)
        shifts = spiral_shifts(shifts, frame.number, samples)
    radii, counts = np.array([radius], np.float64), np.array([samples], np.int64)
    size = max(1, _CHUNK // samples)
    to_light, origins = (np.empty((size, samples, 3), np.float32) for _ in range(2))
    for begin in range(0, len(starts), size):
        part = slice(begin, begin + size)
        points = starts[part]
        vectors, ray_origins = to_light[: len(points)], origins[: len(points)]
        frame.shape.ring_vectors(
            points, shifts[part], on_light, frame.centre, radii, counts, vectors
        )
        ray_origins[:] = points[:, None]
        yield part, ray_origins, vectors


def _shares(blocked: Blocked, starts: np.ndarray, to_light: np.ndarray, normals: np.ndarray):
    """Share of each point's rays (n, samples, 3) unblocked: (n,) float32."""
    hit = blocked(starts.reshape(-1, 3), to_light.reshape(-1, 3))
    return free_shares(hit.reshape(to_light.shape[:2]), to_light, normals)


def spread(frame: SoftFrame, radius: float, *, samples: int) -> np.ndarray:
    """Share of free rays, one from each position in a pixel.

    As a path tracer or a multisampled G-buffer sends them. (n,) float32 of the frame's points.
    """
    images = [
        shifted.surface.image(ray_traced(shifted, radius, samples=1), 1.0)
        for shifted in frame.at_places(_SPREAD[samples])
    ]
    return np.mean(images, axis=0, dtype=np.float32).ravel()[frame.surface.pixel]


@njit(cache=True, nogil=True)
def _mean_penumbra(blocked, free, to_light, normals, radius):
    """Mean penumbra radius by blockers above the plane; −1 without."""
    points, samples = blocked.shape
    penumbra = np.empty(points, np.float32)
    for i in range(points):
        x, y, z = normals[i, 0], normals[i, 1], normals[i, 2]
        total, count = 0.0, 0
        for k in range(samples):
            u, v, w = to_light[i, k, 0], to_light[i, k, 1], to_light[i, k, 2]
            if x * u + y * v + z * w > 0 and blocked[i, k]:
                total += radius * free[i, k] / (1 - free[i, k])
                count += 1
        penumbra[i] = total / count if count else -1
    return penumbra
