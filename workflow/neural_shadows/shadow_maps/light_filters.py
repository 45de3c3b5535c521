"""What a map of a light's distances says of receivers: hard, filtered, and by blocker search.

Percentage-closer filtering (Reeves et al. 1987) and percentage-closer soft shadows (Fernando 2005),
whose kernel is as wide as the penumbra of the blockers that it finds. Kernels are discs of directions
round the receiver's, so that they go on from face to face of a cube.
"""

import numpy as np
from numba import njit

from neural_shadows.shadow_maps.light_map import LightMap, texel_of

MOST_SLOPE = 20.0  # texels
_GOLDEN_ANGLE = 2.399963229728653


def receiver_bias(
    light_map: LightMap, ways: np.ndarray, cosines: np.ndarray, scene_size: float
) -> np.ndarray:
    """By how much a receiver may lie behind its texel and still be lit, (n,) float32.

    h · min(0.5 + 0.75 tan θ, 20) + 1e-4 of the scene's size, h the width of a texel at the receiver
    and θ the angle between its geometric normal and the light: as directional maps have it.

    Args:
        ways: (n, 3) from the light to receivers; cosines: (n,), of θ.
    """
    distance = np.linalg.norm(ways, axis=1)
    texel = light_map.texel_size(ways / distance[:, None]) * distance
    tangent = np.sqrt(1 / np.clip(cosines, 0.01, 1) ** 2 - 1)
    slope = np.minimum(0.5 + 0.75 * tangent, MOST_SLOPE)
    return (texel * slope + 1e-4 * scene_size).astype(np.float32)


def hard_visibility(
    light_map: LightMap, depths: np.ndarray, ways: np.ndarray, bias: np.ndarray
) -> np.ndarray:
    """1 where a receiver is the first in its texel or off the map, else 0: (n,) float32."""
    texels = light_map.texels_of(ways)
    first = np.where(texels < 0, np.float32(np.inf), depths[texels])
    return (np.linalg.norm(ways, axis=1) <= first + bias).astype(np.float32)


def disc_visibility(
    light_map: LightMap,
    depths: np.ndarray,
    ways: np.ndarray,
    bias: np.ndarray,
    *,
    texels: float,
    samples: int,
    keys: np.ndarray,
) -> np.ndarray:
    """Percentage-closer filtering over a disc of so many texels' radius, (n,) float32."""
    angle = texels * 2 * light_map.half / light_map.resolution
    angles = np.full(len(ways), angle, np.float32)
    found = np.empty(len(ways), np.float32)
    maps = light_map.faces, light_map.half, light_map.resolution
    _filter(ways, bias, angles, _vogel_disc(samples), keys, depths, *maps, found)
    return found


def soft_disc_visibility(
    light_map: LightMap,
    depths: np.ndarray,
    ways: np.ndarray,
    bias: np.ndarray,
    *,
    radius: float,
    searched: int = 64,
    samples: int = 128,
    nearest: float = 0.25,
    keys: np.ndarray,
) -> np.ndarray:
    """Percentage-closer soft shadows of a light of a radius, (n,) float32.

    Blockers are looked for where the light can be hidden by one no nearer to it than `nearest` of
    the way; of those found, the mean distance z̄ says how wide the penumbra is: the light's radius
    seen from the receiver, where it passes z̄.

    Args:
        searched, samples: of the search and of the filter, 64 and 128 (Hu et al. 2025, 6.1).
    """
    distance = np.linalg.norm(ways, axis=1)
    maps = light_map.faces, light_map.half, light_map.resolution
    widest = np.float32(radius) * (1 / (nearest * distance) - 1 / distance)
    blockers = np.empty(len(ways), np.float32)
    widest, disc = widest.astype(np.float32), _vogel_disc(searched)
    _mean_blocker(ways, bias, widest, disc, keys, depths, *maps, blockers)
    with np.errstate(divide="ignore", invalid="ignore"):  # where nothing hides a receiver
        angles = radius * (distance - blockers) / (distance * blockers)
    texel = light_map.half / light_map.resolution  # half of one: no narrower than that
    angles = np.where(blockers > 0, np.maximum(angles, texel), 0).astype(np.float32)
    found = np.empty(len(ways), np.float32)
    _filter(ways, bias, angles, _vogel_disc(samples), keys, depths, *maps, found)
    return np.where(blockers > 0, found, np.float32(1))


def _vogel_disc(count: int) -> np.ndarray:
    """Places evenly spread over a unit disc (Vogel 1979), (count, 2)."""
    k = np.arange(count)
    places = np.stack([np.cos(k * _GOLDEN_ANGLE), np.sin(k * _GOLDEN_ANGLE)], axis=1)
    return places * np.sqrt((k + 0.5) / count)[:, None]


@njit(cache=True, nogil=True, inline="always")
def _cone(way, angle, key):
    """The distance to a receiver, the direction to it, and two vectors across that are as long as a
    disc of directions is wide, turned by the receiver's key.
    """
    x, y, z = way[0], way[1], way[2]
    distance = np.sqrt(x * x + y * y + z * z)
    x, y, z = x / distance, y / distance, z / distance
    # Two unit vectors across (Duff et al. 2017).
    sign = 1.0 if z >= 0 else -1.0
    a = -1 / (sign + z)
    b = x * y * a
    ux, uy, uz = 1 + sign * x * x * a, sign * b, -sign * x
    vx, vy, vz = b, sign + y * y * a, -y
    turn = (key * 0.6180339887498949) % 1 * 2 * np.pi
    c, s = angle * np.cos(turn), angle * np.sin(turn)
    u = c * ux + s * vx, c * uy + s * vy, c * uz + s * vz
    v = c * vx - s * ux, c * vy - s * uy, c * vz - s * uz
    return distance, (x, y, z), u, v


@njit(cache=True, nogil=True)
def _filter(ways, bias, angles, disc, keys, depths, faces, half, resolution, visibility):
    """Share of a disc's directions whose texels do not hide the receiver."""
    for i in range(len(ways)):
        distance, (x, y, z), u, v = _cone(ways[i], angles[i], keys[i])
        lit = 0
        for k in range(len(disc)):
            p, q = disc[k, 0], disc[k, 1]
            way = x + p * u[0] + q * v[0], y + p * u[1] + q * v[1], z + p * u[2] + q * v[2]
            texel = texel_of(way[0], way[1], way[2], faces, half, resolution)
            lit += texel < 0 or distance <= depths[texel] + bias[i]
        visibility[i] = lit / len(disc)


@njit(cache=True, nogil=True)
def _mean_blocker(ways, bias, angles, disc, keys, depths, faces, half, resolution, blockers):
    """Mean distance of what hides a receiver in a disc of directions; 0 where nothing does."""
    for i in range(len(ways)):
        distance, (x, y, z), u, v = _cone(ways[i], angles[i], keys[i])
        total, count = 0.0, 0
        for k in range(len(disc)):
            p, q = disc[k, 0], disc[k, 1]
            way = x + p * u[0] + q * v[0], y + p * u[1] + q * v[1], z + p * u[2] + q * v[2]
            texel = texel_of(way[0], way[1], way[2], faces, half, resolution)
            if texel >= 0 and distance > depths[texel] + bias[i]:
                total += depths[texel]
                count += 1
        blockers[i] = total / count if count else 0.0
