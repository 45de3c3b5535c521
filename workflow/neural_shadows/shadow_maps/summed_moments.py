"""Moments of depth of a light's map, averaged over windows of any width at the same cost.

By summed-area tables (Crow 1984) of the faces, as in Lauritzen 2007, "Summed-Area Variance Shadow
Maps". Windows are rectangles of texels round a receiver, for discs of directions: as the disc's picture is
long and wide, times √π / 2, and so of its area. At the rim of a face's view they are cut off.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numba import njit

from neural_shadows.shadow_maps.face_views import face_views
from neural_shadows.shadow_maps.light_map import LightMap

_BAND = 32  # rows summed at once, so that their moments stay in the cache


@dataclass(frozen=True, eq=False)
class SummedView:
    """A face's m receivers, and its moments summed."""

    receivers: np.ndarray  # (m,) int64, indices among all n
    texels: np.ndarray  # (m, 2) float64, a window's rows and columns of discs of tangent 1
    _places: np.ndarray  # (m, 2) float64, row and column, the first texel's corner at 0
    _sums: np.ndarray  # (H + 1, W + 1, moments) float64

    def sides(self, tangents: np.ndarray) -> np.ndarray:
        """Rows and columns of the windows of discs, (m, 2), one at least.

        Args:
            tangents: (m,) of half of the discs' angles.
        """
        return np.maximum(self.texels * tangents[:, None], 1)

    def means(self, sides: np.ndarray) -> np.ndarray:
        """Mean moments of windows of these rows and columns, (m, moments) float64."""
        means = np.empty((len(sides), self._sums.shape[2]))
        _fill_means(self._sums, self._places, sides, means)
        return means


def summed_views(
    light_map: LightMap,
    depths: np.ndarray,
    from_light: np.ndarray,
    *,
    of: Callable[[np.ndarray], np.ndarray],
    far: float,
    widest: np.ndarray,
) -> Iterator[SummedView]:
    """Yield the faces with receivers: of 2048² texels and four moments 0.14 GB each.

    Args:
        depths: (texels,) float32 of the whole map. from_light: (n, 3) from the light to receivers.
        of, far: see `filtered_moments`.
        widest: (n,) tangents of half the angles of the widest discs. A window reaches half a face
            beyond a seam at most.
    """
    near, span = np.float32(light_map.near), np.float32(far - light_map.near)
    texel = 2 * light_map.half / light_map.resolution
    # The longest that a disc's picture is: in a face's corner.
    longest = np.sqrt(np.pi) * (1 + 2 * light_map.half**2) / texel * widest.max(initial=0)
    kernel = 2 * int(min(longest, light_map.resolution) / 2) + 3
    for view in face_views(light_map, depths, from_light, kernel):
        sums = _summed(np.minimum((view.depths - near) / span, 1), of)
        tangents = (np.asarray(view.corner) + view.places + 0.5) * texel - light_map.half
        squares = tangents**2
        aslant = np.sqrt(1 + squares.sum(axis=1, keepdims=True))
        texels = np.sqrt(np.pi) * aslant * np.sqrt(1 + squares) / texel
        yield SummedView(view.receivers, texels, view.places + 0.5, sums)


def _summed(depths: np.ndarray, of: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Moments of depths (H, W) summed above and left of each corner, (H + 1, W + 1, moments)."""
    height, width = depths.shape
    sums = np.zeros((height + 1, width + 1, of(np.ones(1)).shape[1]))
    for k in range(0, height, _BAND):
        _fill_sums(of(depths[k : k + _BAND]), sums[k : k + _BAND + 1])
    return sums


@njit(cache=True, nogil=True)
def _fill_sums(values, sums):
    """Sums of values (rows, W, moments) below those of the first row of sums."""
    height, width, count = values.shape
    for row in range(height):
        line = np.zeros(count)
        for column in range(width):
            for k in range(count):
                line[k] += values[row, column, k]
                sums[row + 1, column + 1, k] = sums[row, column + 1, k] + line[k]


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_means(sums, places, sides, means):
    """Mean values of rectangles round places (m, 2), of sides (m, 2): within the table."""
    height, width = sums.shape[0] - 1, sums.shape[1] - 1
    for i in range(len(places)):
        top = max(places[i, 0] - sides[i, 0] / 2, 0.0)
        bottom = min(places[i, 0] + sides[i, 0] / 2, float(height))
        left = max(places[i, 1] - sides[i, 1] / 2, 0.0)
        right = min(places[i, 1] + sides[i, 1] / 2, float(width))
        share = 1 / ((bottom - top) * (right - left))
        means[i] = 0
        _add(sums, bottom, right, share, means[i])
        _add(sums, bottom, left, -share, means[i])
        _add(sums, top, right, -share, means[i])
        _add(sums, top, left, share, means[i])


@njit(cache=True, nogil=True, error_model="numpy")
def _add(sums, y, x, weight, into):
    """Add a table's weighted value between its corners: exact, as texels are constant."""
    row, column = min(int(y), sums.shape[0] - 2), min(int(x), sums.shape[1] - 2)
    down, right = y - row, x - column
    a, b = weight * (1 - down) * (1 - right), weight * (1 - down) * right
    c, d = weight * down * (1 - right), weight * down * right
    for k in range(sums.shape[2]):
        above = a * sums[row, column, k] + b * sums[row, column + 1, k]
        below = c * sums[row + 1, column, k] + d * sums[row + 1, column + 1, k]
        into[k] += above + below
