"""Blockers in a light map, over discs of directions round receivers.

Most discs lie within one face of the map: there a sample is one projective look-up without
branches, in float32, which the compiler does for several samples at once (1 ns each with AVX-512,
10 ns one by one). Discs that reach over a cube's seams or a picture's rim are looked up by each
sample's direction.

A texel is compared with the receiver's plane along its centre's direction (receiver plane depth bias,
Isidoro 2006): against the receiver's own distance a slanted receiver hides itself, the wider the disc
the more.
"""

import numpy as np
from numba import njit

from neural_shadows.rendering.perpendicular import perpendicular
from neural_shadows.shadow_maps.light_map import LightMap, texel_of

_GOLDEN_ANGLE = 2.399963229728653
_NEW_ORDER = {"reassoc", "contract", "arcp", "nsz"}  # of sums; infinite depths stay
# The plane is followed up to half and to twice the receiver's distance: beyond, it is seen at
# a grazing angle, and the texel shows another surface.
LEAST_RATIO, MOST_RATIO = 0.5, 2.0
_GRAZING = 1e-3  # cosine below which a receiver's plane is ignored


def vogel_disc(count: int) -> np.ndarray:
    """Places evenly spread over a unit disc (Vogel 1979), (2, count) float32."""
    k = np.arange(count)
    places = np.stack([np.cos(k * _GOLDEN_ANGLE), np.sin(k * _GOLDEN_ANGLE)])
    return (places * np.sqrt((k + 0.5) / count)).astype(np.float32)


def looked_up(light_map: LightMap, depths: np.ndarray) -> tuple:
    """Arguments of `blockers` for a map.

    Its depths (texels,) float32, each face's projection (F, 3, 3) from a direction to
    (column · w, row · w, w) in texels, and its faces, half and resolution.
    """
    right, down, forward = light_map.faces.transpose(1, 0, 2)
    middle = light_map.resolution / 2
    scale = middle / light_map.half
    rows = scale * right + middle * forward, scale * down + middle * forward, forward
    geometry = light_map.faces, light_map.half, light_map.resolution
    return depths, np.stack(rows, axis=1), *geometry


@njit(cache=True, nogil=True, error_model="numpy")
def across(x, y, z, key):
    """Two unit vectors across a unit vector, turned by a receiver's key."""
    (ux, uy, uz), (vx, vy, vz) = perpendicular(x, y, z)
    turns = key * 0.6180339887498949
    turn = np.float32(2 * np.pi * (turns - np.floor(turns)))
    c, s = np.cos(turn), np.sin(turn)
    u = c * ux + s * vx, c * uy + s * vy, c * uz + s * vz
    v = c * vx - s * ux, c * vy - s * uy, c * vz - s * uz
    return u, v


@njit(cache=True, nogil=True, error_model="numpy")
def blockers(disc, receiver, u, v, angle, depths, projections, faces, half, resolution):
    """Count and summed depths of texels before the receiver's plane, in a disc.

    Args:
        disc: places in a unit disc, (2, samples) float32. u, v: see `across`. angle: the tangent of
            half the disc's angle.
        receiver: the unit direction to it, its distance, its depth bias, and its unit normal.
        depths, projections, faces, half, resolution: see `looked_up`, one by one, since numba counts
            a tuple's arrays anew for each receiver; no blockers beyond a map's rim.
    """
    direction = receiver[0]
    face = _face_of(projections, direction)
    if face >= 0:
        column = _along_disc(projections, face, 0, direction, u, v, angle)
        row = _along_disc(projections, face, 1, direction, u, v, angle)
        w = _along_disc(projections, face, 2, direction, u, v, angle)
        if _within(column, w, resolution) and _within(row, w, resolution):
            plane = plane_in_face(receiver, faces[face], half, resolution)
            begin = face * resolution * resolution
            return _in_face(disc, column, row, w, plane, depths, begin, resolution, half)
    return _anywhere(disc, receiver, u, v, angle, depths, faces, half, resolution)


@njit(cache=True, nogil=True, error_model="numpy")
def plane_in_face(receiver, axes, half, resolution):
    """The receiver's plane in the texels of a face.

    Args:
        receiver: see `blockers`. axes: right, down and forward of the face, (3, 3).

    Returns:
        The distance of the receiver along the face's forward axis, and `(middle, by column, by row)`:
        that of the plane in the texel (row, column) is the former over middle + by column · column +
        by row · row, and as much farther from the light as the texel looks aslant.
        The bias, last.
    """
    direction, distance, bias, normal = receiver
    ahead = direction[0] * axes[2, 0] + direction[1] * axes[2, 1] + direction[2] * axes[2, 2]
    towards = (
        normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2]
    ) / ahead
    if abs(towards) * ahead < _GRAZING:
        return distance * ahead, (1.0, 0.0, 0.0), bias
    right = normal[0] * axes[0, 0] + normal[1] * axes[0, 1] + normal[2] * axes[0, 2]
    down = normal[0] * axes[1, 0] + normal[1] * axes[1, 1] + normal[2] * axes[1, 2]
    forward = normal[0] * axes[2, 0] + normal[1] * axes[2, 1] + normal[2] * axes[2, 2]
    texel = 2 * half / resolution
    corner = texel / 2 - half
    middle = (forward + corner * (right + down)) / towards
    return distance * ahead, (middle, texel * right / towards, texel * down / towards), bias


@njit(cache=True, nogil=True, error_model="numpy")
def _anywhere(disc, receiver, u, v, angle, depths, faces, half, resolution):
    """`blockers` of any disc, by the direction of each sample."""
    direction = receiver[0]
    count, total = 0, np.float32(0)
    for k in range(disc.shape[1]):
        p, q = angle * disc[0, k], angle * disc[1, k]
        x, y = direction[0] + p * u[0] + q * v[0], direction[1] + p * u[1] + q * v[1]
        texel = texel_of(x, y, direction[2] + p * u[2] + q * v[2], faces, half, resolution)
        if texel >= 0 and depths[texel] < _nearest_in(receiver, texel, faces, half, resolution):
            total += depths[texel]
            count += 1
    return count, total


@njit(cache=True, nogil=True, error_model="numpy")
def _nearest_in(receiver, texel, faces, half, resolution):
    """Least distance of a texel's surface not before the receiver's plane."""
    face, place = divmod(texel, resolution * resolution)
    row, column = divmod(place, resolution)
    p = ((column + 0.5) / resolution * 2 - 1) * half
    q = ((row + 0.5) / resolution * 2 - 1) * half
    axes = faces[face]
    aslant = np.sqrt(1 + p * p + q * q)
    direction, distance, bias, normal = receiver
    texel_dot = receiver_dot = 0.0
    for k in range(3):
        texel_dot += normal[k] * (axes[2, k] + p * axes[0, k] + q * axes[1, k]) / aslant
        receiver_dot += normal[k] * direction[k]
    ratio = texel_dot / receiver_dot if abs(receiver_dot) >= _GRAZING else 1.0
    return distance / min(max(ratio, LEAST_RATIO), MOST_RATIO) - bias


@njit(cache=True, nogil=True, error_model="numpy")
def _face_of(projections, direction):
    """Face of a direction, even beyond its rim; −1 for none."""
    best, along = -1, 0.0
    for face in range(len(projections)):
        forward = _dot(projections, face, 2, direction)
        if forward > along:
            best, along = face, forward
    return best


@njit(cache=True, nogil=True, error_model="numpy")
def _along_disc(projections, face, k, direction, u, v, angle):
    """A coordinate linear over a disc: in its middle, by p and q."""
    middle = _dot(projections, face, k, direction)
    return middle, angle * _dot(projections, face, k, u), angle * _dot(projections, face, k, v)


@njit(cache=True, nogil=True, error_model="numpy")
def _dot(projections, face, k, direction):
    a, b, c = projections[face, k, 0], projections[face, k, 1], projections[face, k, 2]
    return a * direction[0] + b * direction[1] + c * direction[2]


@njit(cache=True, nogil=True, error_model="numpy")
def _within(place, w, resolution):
    """Test a disc's margin of half a texel: more than float32 rounds."""
    near, far = 0.5, resolution - 0.5
    p, q = place[1] - near * w[1], place[2] - near * w[2]
    r, s = place[1] - far * w[1], place[2] - far * w[2]
    nearest = place[0] - near * w[0] - np.sqrt(p * p + q * q)
    farthest = place[0] - far * w[0] + np.sqrt(r * r + s * s)
    return nearest > 0 and farthest < 0


@njit(cache=True, nogil=True, fastmath=_NEW_ORDER, error_model="numpy")
def _in_face(disc, column, row, w, plane, depths, begin, resolution, half):
    """`blockers` of a disc within a face, by homogeneous coordinates.

    Args:
        plane: see `plane_in_face`. begin: of the face's texels in `depths`.
    """
    c0, cp, cq = np.float32(column[0]), np.float32(column[1]), np.float32(column[2])
    r0, rp, rq = np.float32(row[0]), np.float32(row[1]), np.float32(row[2])
    w0, wp, wq = np.float32(w[0]), np.float32(w[1]), np.float32(w[2])
    ahead, slopes, bias = np.float32(plane[0]), plane[1], np.float32(plane[2])
    middle, across_, along = np.float32(slopes[0]), np.float32(slopes[1]), np.float32(slopes[2])
    texel, corner = np.float32(2 * half / resolution), np.float32(half / resolution - half)
    least, most, unit = np.float32(LEAST_RATIO), np.float32(MOST_RATIO), np.float32(1)
    begin, width = np.int32(begin), np.int32(resolution)
    count, total = np.float32(0), np.float32(0)
    for k in range(disc.shape[1]):
        p, q = disc[0, k], disc[1, k]
        inverse = unit / (w0 + p * wp + q * wq)
        i = np.int32((c0 + p * cp + q * cq) * inverse)
        j = np.int32((r0 + p * rp + q * rq) * inverse)
        x, y = np.float32(i), np.float32(j)
        a, b = corner + texel * x, corner + texel * y
        ratio = min(max(middle + across_ * x + along * y, least), most)
        nearest = ahead * np.sqrt(unit + a * a + b * b) / ratio - bias
        # Unsigned, else numba tests for negative indices.
        depth = depths[np.uint32(np.int32(begin + j * width + i))]
        count += np.float32(depth < nearest)
        total += depth if depth < nearest else np.float32(0)
    return np.int64(count), total
