"""Percentage-closer filtering over k × k texels (Reeves et al. 1987), as graphics hardware has it."""

import numpy as np
from numba import njit

from neural_shadows.shadow_maps.face_views import face_views
from neural_shadows.shadow_maps.light_map import LightMap, distances_of


def box_visibility(
    light_map: LightMap, depths: np.ndarray, ways: np.ndarray, bias: np.ndarray, *, size: int
) -> np.ndarray:
    """Mean over size × size texels of bilinearly weighted tests, (n,) float32; off the map 1.

    Of size 1 it is the four tests round a receiver. 15 × 15 take 0.5 s on one core, for 2048 × 1024
    receivers in one face of 1024².

    Args:
        depths: (texels,) float32 of the whole map. ways: (n, 3) from the light to receivers.
        bias: (n,) by how much a receiver may lie behind a texel and still be lit.
        size: odd.
    """
    distances = distances_of(ways)
    visibility = np.ones(len(ways), np.float32)
    for view in face_views(light_map, depths, ways, size):
        nearest = (distances - bias)[view.receivers].astype(np.float32)
        visibility[view.receivers] = _share_beyond(view.depths, view.places, nearest, size)
    return visibility


@njit(cache=True, nogil=True)
def _share_beyond(depths, places, nearest, size):
    """Share of the kernel round each place that is no nearer to the light than it may be."""
    shares = np.empty(len(places), np.float32)
    for i in range(len(places)):
        top, left = int(np.floor(places[i, 0])), int(np.floor(places[i, 1]))
        down, right = places[i, 0] - top, places[i, 1] - left
        top, left = top - size // 2, left - size // 2
        total = 0.0
        # Neighbouring tests share texels: inner ones count whole, the outermost by their part.
        for row in range(top, top + size + 1):
            inner = 0
            for column in range(left + 1, left + size):
                inner += depths[row, column] >= nearest[i]
            first = depths[row, left] >= nearest[i]
            last = depths[row, left + size] >= nearest[i]
            weight = 1 - down if row == top else down if row == top + size else 1.0
            total += weight * (inner + (1 - right) * first + right * last)
        shares[i] = total / size**2
    return shares
