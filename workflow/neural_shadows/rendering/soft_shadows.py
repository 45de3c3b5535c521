"""Exact soft shadows of area lights of several radii, by rays.

Eight places in each pixel, each with its own surface, so that shadows' edges are smooth as well
(Datta et al. 2022, 3.1 and supplement 5). Most pixels are wholly lit or dark for every radius: a few
rays find them, if their neighbourhood agrees.
"""

from collections.abc import Sequence
from concurrent.futures import Executor

import numpy as np
from numba import njit
from scipy.ndimage import maximum_filter, minimum_filter

from neural_shadows.rendering.light_samples import ring_shares
from neural_shadows.rendering.light_shape import SPHERE, LightShape
from neural_shadows.rendering.surface import Surface, see_surface
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.scene import Scene

# Eight queens: places in a pixel, in eighths, no two of a row, a column or a diagonal.
_QUEENS = (0, 4, 7, 5, 2, 6, 1, 3)
PLACES = tuple(((column + 0.5) / 8, (row + 0.5) / 8) for column, row in enumerate(_QUEENS))
CENTRE = (0.5, 0.5)
# Offset of ray origins from the surface to the seen side, in shares of the scene's size.
OFFSET = 1e-4
_NEIGHBOURHOOD = 5  # pixels along an axis that must agree for few rays
_RAYS = 1 << 18  # at once: their memory stays in a cache


def soft_visibility(
    scene: Scene,
    camera: Camera,
    width: int,
    height: int,
    *,
    centre: np.ndarray,
    radii: Sequence[float],
    samples: int,
    shape: LightShape = SPHERE,
    adaptive: bool = True,
    pool: Executor | None = None,
    surfaces: Sequence[Surface] | None = None,
) -> np.ndarray:
    """Trace visibility for each radius: (radii, height, width) float32.

    1 where there is no surface, 0 where the surface is turned from the light.

    Args:
        centre: (3,) of the light. radii: of the lights, growing; the first may be 0, a point.
        samples: rays for every place in a pixel and every ring between two radii.
        adaptive: leave pixels at two rays a place where they and their neighbours agree: less
            than 5e-4 off on average.
        pool: whose threads share the places; Embree and the kernels need no interpreter.
        surfaces: the camera's surfaces at the places, by default at `PLACES`.
    """
    rings = np.array([radius for radius in radii if radius > 0], np.float64)
    run = pool.map if pool else map
    surfaces = surfaces or see_places(scene, camera, width, height, pool=pool)
    light = shape, centre, rings
    rays = [_Place(scene, surface, index, *light) for index, surface in enumerate(surfaces)]
    hard = np.stack([*run(lambda place: place.hard(), rays)])
    mixed = np.ones((height, width), bool)
    if adaptive:
        low, high = zip(*run(lambda place: place.pilot(), rays))
        low = np.minimum(np.min(low, axis=0), hard.min(0))
        high = np.maximum(np.max(high, axis=0), hard.max(0))
        mixed = minimum_filter(low, _NEIGHBOURHOOD) < maximum_filter(high, _NEIGHBOURHOOD)
    visibility = np.empty((len(radii), height, width), np.float32)
    visibility[:] = hard.mean(0)
    if len(rings):
        shares = ring_shares(rings)
        by_ring = sum(run(lambda place: place.by_ring(mixed, samples), rays)) / len(rays)
        visibility[len(radii) - len(rings) :, mixed] = shares @ by_ring
    return visibility


def see_places(
    scene: Scene,
    camera: Camera,
    width: int,
    height: int,
    places: Sequence[tuple[float, float]] = PLACES,
    pool: Executor | None = None,
) -> list[Surface]:
    """Trace a camera's surfaces at places in pixels, in pixel sides."""
    run = pool.map if pool else map
    return [*run(lambda place: see_surface(scene, camera, width, height, place), places)]


class _Place:
    """The rays of one place in all pixels."""

    def __init__(
        self,
        scene: Scene,
        surface: Surface,
        index: int,
        shape: LightShape,
        centre: np.ndarray,
        rings: np.ndarray,
    ):
        self.scene, self.surface, self.index = scene, surface, index
        self.shape, self.centre, self.rings = shape, np.asarray(centre, np.float64), rings
        self.start = surface.p + np.float32(OFFSET * scene.size) * surface.n_g

    def hard(self) -> np.ndarray:
        """Visibility of the light's centre, (height, width) float32."""
        to_light = self.centre.astype(np.float32) - self.start
        return self.surface.image(self._seen(self.start, to_light, self.surface.n_g), 1.0)

    def pilot(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and most of two rays, one outermost: (height, width) float32."""
        counts = np.zeros(len(self.rings), np.int64)
        if len(counts):
            counts[-1] += 1
            counts[self.index % len(counts)] += 1
        low, high = (np.ones(len(self.start), np.float32) for _ in range(2))
        for part, seen in self._rays(np.arange(len(self.start)), counts, first=self.index):
            low[part], high[part] = seen.min(1), seen.max(1)
        return self.surface.image(low, 1.0), self.surface.image(high, 1.0)

    def by_ring(self, mixed: np.ndarray, samples: int) -> np.ndarray:
        """Visibility of every ring at mixed pixels: (rings, mixed pixels) float32."""
        indices = np.flatnonzero(mixed.ravel()[self.surface.pixel])
        visibility = np.ones(
            (self.surface.height * self.surface.width, len(self.rings)), np.float32
        )
        counts = np.full(len(self.rings), samples, np.int64)
        for part, seen in self._rays(indices, counts, first=self.index * samples):
            rings = seen.reshape(len(part), len(self.rings), samples).mean(2)
            visibility[self.surface.pixel[part]] = rings
        return visibility[mixed.ravel()].T

    def _rays(self, points: np.ndarray, counts: np.ndarray, first: int):
        """Yield parts of points: (part,) indices, visibility (part, Σ counts)."""
        count = int(counts.sum())
        size = max(1, _RAYS // max(1, count))
        to_light = np.empty((size, count, 3), np.float32)
        starts = np.empty((size, count, 3), np.float32)
        for begin in range(0, len(points) if count else 0, size):
            part = points[begin : begin + size]
            start = np.take(self.start, part, axis=0)
            vectors, origins = to_light[: len(part)], starts[: len(part)]
            self.shape.ring_vectors(
                start, self.surface.pixel[part], first, self.centre, self.rings, counts, vectors
            )
            origins[:] = start[:, None]
            normals = np.take(self.surface.n_g, part, axis=0)
            seen = self._seen(origins.reshape(-1, 3), vectors.reshape(-1, 3), normals, count)
            yield part, seen.reshape(len(part), count)

    def _seen(self, starts, to_light, normals, count: int = 1) -> np.ndarray:
        """Visibility by free rays on the seen side: (n,) float32."""
        seen = (~self.scene.tracer.blocked(starts, to_light)).astype(np.float32)
        _darken(seen, to_light, normals, count)
        return seen


@njit(cache=True, nogil=True)
def _darken(seen, to_light, normals, count):
    for ray in range(len(seen)):
        n = normals[ray // count]
        if n[0] * to_light[ray, 0] + n[1] * to_light[ray, 1] + n[2] * to_light[ray, 2] <= 0:
            seen[ray] = 0
