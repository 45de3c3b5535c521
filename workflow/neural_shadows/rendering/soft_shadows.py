"""Exact soft shadows of area lights of several radii, by rays.

Eight places in each pixel, each with its own surface, so that shadows' edges are smooth as well
(Datta et al. 2022, 3.1 and supplement 5). Most pixels are wholly lit or dark for every radius: a few
rays find them, if their neighbourhood agrees.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numba import njit
from scipy.ndimage import maximum_filter, minimum_filter

from neural_shadows.rendering.light_samples import random_shifts, ring_shares, sequence_run
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
_NEIGHBOURHOOD = 7  # pixels along an axis that must agree for few rays
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
    surfaces: Sequence[Surface] | None = None,
    salt: int = 0,
) -> np.ndarray:
    """Trace visibility for each radius: (radii, height, width) float32.

    1 where there is no surface, 0 where the surface is turned from the light.

    Args:
        centre: (3,) of the light. radii: of the lights, growing; the first may be 0, a point.
        samples: rays for every place in a pixel and every ring between two radii.
        adaptive: leave a ring at few rays where these and its neighbours' agree: less than 5e-4 off
            on average.
        surfaces: the camera's surfaces at the places, by default at `PLACES`.
        salt: added to pixels as keys of `random_shifts`, for errors that are independent of another answer's.
    """
    rings = np.array([radius for radius in radii if radius > 0], np.float64)
    surfaces = surfaces or see_places(scene, camera, width, height)
    light = shape, centre, rings, salt
    places = [_Place(scene, surface, index, *light) for index, surface in enumerate(surfaces)]
    hard, mixed = (
        np.ones((height, width), np.float32),
        np.ones((len(rings) + 1, height, width), bool),
    )
    if adaptive:
        hard, mixed = _pilot(places)

    def averaged(pixels: np.ndarray, visibility: Callable[["_Place"], np.ndarray]) -> np.ndarray:
        """Mean of the places at some pixels (height, width) bool."""
        return sum(image[pixels] for image in map(visibility, places)) / len(places)

    # All places once any ring is mixed: shadows' edges are smooth even of a point.
    some = mixed.any(axis=0)
    hard[some] = averaged(some, lambda place: place.hard(some))
    visibility = np.repeat(hard[None], len(radii), axis=0)
    if len(rings):
        by_ring = np.repeat(hard[None], len(rings), axis=0)
        for ring, pixels in enumerate(mixed[1:]):
            by_ring[ring, pixels] = averaged(
                pixels, lambda place, ring=ring, pixels=pixels: place.ring(ring, pixels, samples)
            )
        lights = visibility[len(radii) - len(rings) :]
        lights[:, some] = ring_shares(rings) @ by_ring[:, some]
    return visibility


def _pilot(places: "Sequence[_Place]") -> tuple[np.ndarray, np.ndarray]:
    """Few rays from every second place in each pixel.

    Returns:
        Visibility of the light's centre from one of them, (height, width) float32; and pixels to be
        sampled, (1 + rings, height, width) bool, for the centre and for each ring: of lights up to
        that ring not all rays of a neighbourhood agree.
    """
    seen = [*map(_Place.pilot, places[::2])]
    mixed = []
    for low, high in zip(*(zip(*levels) for levels in zip(*seen))):
        least, most = np.min(low, axis=0), np.max(high, axis=0)
        mixed.append(minimum_filter(least, _NEIGHBOURHOOD) < maximum_filter(most, _NEIGHBOURHOOD))
    return seen[0][0][0].copy(), np.array(mixed)


def see_places(
    scene: Scene,
    camera: Camera,
    width: int,
    height: int,
    places: Sequence[tuple[float, float]] = PLACES,
) -> list[Surface]:
    """Trace a camera's surfaces at places in pixels, in pixel sides."""
    return [see_surface(scene, camera, width, height, place) for place in places]


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
        salt: int,
    ):
        self.scene, self.surface, self.index = scene, surface, index
        self.shape, self.centre, self.rings = shape, np.asarray(centre, np.float64), rings
        self.keys = surface.pixel + salt
        self.start = surface.p + np.float32(OFFSET * scene.size) * surface.n_g

    def hard(self, pixels: np.ndarray) -> np.ndarray:
        """Visibility of the light's centre at some pixels, (height, width) float32; else 1."""
        points = self._points(pixels)
        start = np.take(self.start, points, axis=0)
        to_light = self.centre.astype(np.float32) - start
        seen = np.ones(len(self.start), np.float32)
        seen[points] = self._seen(start, to_light, np.take(self.surface.n_g, points, axis=0), 1)
        return self.surface.image(seen, 1.0)

    def pilot(self) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """Least and most visible by few rays: of the centre, and of lights up to each ring.

        (height, width) float32 each. One ray to the centre, one to an inner ring, one to the
        outermost.
        """
        everywhere = np.ones((self.surface.height, self.surface.width), bool)
        low = high = self.hard(everywhere)
        lows, highs = [low], [high]
        outermost = len(self.rings) - 1
        for ring in range(len(self.rings)):
            if ring in (self.index // 2 % len(self.rings), outermost):
                seen = self.ring(ring, everywhere, 1)
                low, high = np.minimum(low, seen), np.maximum(high, seen)
            lows.append(low)
            highs.append(high)
        return lows, highs

    def ring(self, ring: int, pixels: np.ndarray, samples: int) -> np.ndarray:
        """Visibility of a ring at some pixels, (height, width) float32; else 1."""
        points, count = self._points(pixels), samples
        counts = np.zeros(len(self.rings), np.int64)
        counts[ring] = samples
        run = sequence_run(self.index * samples, samples)
        seen = np.ones(len(self.start), np.float32)
        size = max(1, _RAYS // count)
        to_light, starts = np.empty((2, size, count, 3), np.float32)
        for begin in range(0, len(points), size):
            part = points[begin : begin + size]
            start = np.take(self.start, part, axis=0)
            vectors, origins = to_light[: len(part)], starts[: len(part)]
            shifts = random_shifts(self.keys[part], len(self.rings))
            self.shape.ring_vectors(start, shifts, run, self.centre, self.rings, counts, vectors)
            origins[:] = start[:, None]
            normals = np.take(self.surface.n_g, part, axis=0)
            rays = origins.reshape(-1, 3), vectors.reshape(-1, 3)
            seen[part] = self._seen(*rays, normals, count)
        return self.surface.image(seen, 1.0)

    def _points(self, pixels: np.ndarray) -> np.ndarray:
        """Indices of the points at some pixels."""
        return np.flatnonzero(pixels.ravel()[self.surface.pixel])

    def _seen(self, starts, to_light, normals, count: int) -> np.ndarray:
        """Share of `count` rays of each point that are free on its seen side, (n,) float32."""
        blocked = self.scene.tracer.blocked(starts, to_light)
        return free_shares(blocked.reshape(-1, count), to_light.reshape(-1, count, 3), normals)


@njit(cache=True, nogil=True)
def free_shares(blocked, to_light, normals):
    """Share of each point's rays (n, samples) that is free and above the surface's plane, (n,) float32.

    Args:
        to_light: (n, samples, 3); normals: (n, 3).
    """
    points, samples = blocked.shape
    shares = np.empty(points, np.float32)
    for i in range(points):
        x, y, z = normals[i, 0], normals[i, 1], normals[i, 2]
        free = 0
        for k in range(samples):
            u, v, w = to_light[i, k, 0], to_light[i, k, 1], to_light[i, k, 2]
            free += x * u + y * v + z * w > 0 and not blocked[i, k]
        shares[i] = free / samples
    return shares
