"""Percentage-closer filtering over k × k texels (Reeves et al. 1987).

Each texel is compared with the receiver's plane at its centre, see `light_discs`.
"""

import numpy as np
from numba import njit

from neural_shadows.shadow_maps.face_views import FaceView, face_views
from neural_shadows.shadow_maps.light_discs import LEAST_RATIO, MOST_RATIO, plane_in_face
from neural_shadows.shadow_maps.light_map import LightMap


def box_visibility(
    light_map: LightMap,
    depths: np.ndarray,
    from_light: np.ndarray,
    normals: np.ndarray,
    bias: np.ndarray,
    *,
    size: int,
) -> np.ndarray:
    """Mean bilinear depth test over size × size texels, (n,) float32.

    Off the map 1. Of size 1 it is the four tests round a receiver.

    Args:
        depths: (texels,) float32 of the whole map. from_light: (n, 3) from the light to receivers.
        normals: (n, 3) of the receivers, geometric.
        bias: (n,) depth bias.
        size: odd.
    """
    visibility = np.ones(len(from_light), np.float32)
    for view in face_views(light_map, depths, from_light, size):
        receivers = [
            np.take(values, view.receivers, axis=0) for values in (from_light, normals, bias)
        ]
        planes = _planes(
            *receivers, light_map.faces[view.face], light_map.half, light_map.resolution
        )
        ahead = _ahead(view, light_map)
        visibility[view.receivers] = _share_beyond(ahead, view.places, planes, view.corner, size)
    return visibility


def _ahead(view: FaceView, light_map: LightMap) -> np.ndarray:
    """The view's depths along the face's forward axis."""
    rows, columns = (
        ((begin + np.arange(count) + 0.5) / light_map.resolution * 2 - 1) * light_map.half
        for begin, count in zip(view.corner, view.depths.shape)
    )
    ahead = np.empty(view.depths.shape, np.float32)
    _fill_ahead(view.depths, rows.astype(np.float32), columns.astype(np.float32), ahead)
    return ahead


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_ahead(depths, rows, columns, ahead):
    one = np.float32(1)
    for row in range(len(rows)):
        for column in range(len(columns)):
            aslant = np.sqrt(one + rows[row] * rows[row] + columns[column] * columns[column])
            ahead[row, column] = depths[row, column] / aslant


@njit(cache=True, nogil=True, error_model="numpy")
def _planes(from_light, normals, bias, axes, half, resolution):
    """Receivers' distances, planes (3) and bias along the forward axis: (n, 5) float64."""
    planes = np.empty((len(from_light), 5))
    for i in range(len(from_light)):
        x, y, z = (
            np.float64(from_light[i, 0]),
            np.float64(from_light[i, 1]),
            np.float64(from_light[i, 2]),
        )
        distance = np.sqrt(x * x + y * y + z * z)
        direction = x / distance, y / distance, z / distance
        normal = np.float64(normals[i, 0]), np.float64(normals[i, 1]), np.float64(normals[i, 2])
        receiver = direction, distance, np.float64(bias[i]), normal
        ahead, slopes, behind = plane_in_face(receiver, axes, half, resolution)
        planes[i, 0], planes[i, 4] = ahead, behind * ahead / distance
        planes[i, 1], planes[i, 2], planes[i, 3] = slopes
    return planes


@njit(cache=True, nogil=True, error_model="numpy")
def _share_beyond(ahead, places, planes, corner, size):
    """Kernel's share not before the receiver's plane, for each place."""
    shares = np.empty(len(places), np.float32)
    side = size + 1
    beyond = np.empty(side, np.float32)
    for i in range(len(places)):
        top, left = int(np.floor(places[i, 0])), int(np.floor(places[i, 1]))
        down, right = places[i, 0] - top, places[i, 1] - left
        top, left = top - size // 2, left - size // 2
        distance, bias = np.float32(planes[i, 0]), np.float32(planes[i, 4])
        across, along = np.float32(planes[i, 2]), np.float32(planes[i, 3])
        middle = np.float32(planes[i, 1] + planes[i, 2] * (left + corner[1]))
        total = 0.0
        # Neighbouring tests share texels: inner ones count whole, the outermost by their part.
        for row in range(top, top + side):
            row_ratio = middle + along * np.float32(row + corner[0])
            for k in range(side):
                ratio = row_ratio + across * np.float32(k)
                ratio = min(max(ratio, np.float32(LEAST_RATIO)), np.float32(MOST_RATIO))
                beyond[k] = ahead[row, left + k] >= distance / ratio - bias
            inner = beyond[1:size].sum()
            weight = 1 - down if row == top else down if row == top + size else 1.0
            total += weight * (inner + (1 - right) * beyond[0] + right * beyond[size])
        shares[i] = total / size**2
    return shares
