"""What a map of a light's distances says of receivers: hard, filtered, and by blocker search.

Percentage-closer filtering (Reeves et al. 1987) and percentage-closer soft shadows (Fernando 2005),
whose kernel is as wide as the penumbra of the blockers that it finds. Kernels are discs of directions
round the receiver's, so that they go on from face to face of a cube.
"""

import numpy as np
from numba import njit

from neural_shadows.shadow_maps.light_discs import across, blockers, looked_up, vogel_disc
from neural_shadows.shadow_maps.light_map import LightMap, distances_of

MOST_SLOPE = 20.0  # texels


def receiver_bias(
    light_map: LightMap,
    ways: np.ndarray,
    cosines: np.ndarray,
    scene_size: float,
    reach: float = 0.75,
) -> np.ndarray:
    """By how much a receiver may lie behind its texel and still be lit, (n,) float32.

    h · min(0.5 + reach tan θ, 20) + 1e-4 of the scene's size, h the width of a texel at the receiver
    and θ the angle between its geometric normal and the light: as directional maps have it.

    Args:
        ways: (n, 3) from the light to receivers; cosines: (n,), of θ.
        reach: in texels, from the receiver's; of a filtered map the filter's, too (a cone bias).
    """
    distance = distances_of(ways)
    texel = light_map.texel_size(ways / distance[:, None]) * distance
    tangent = np.sqrt(1 / np.clip(cosines, 0.01, 1) ** 2 - 1)
    slope = np.minimum(0.5 + reach * tangent, MOST_SLOPE)
    return (texel * slope + 1e-4 * scene_size).astype(np.float32)


def hard_visibility(
    light_map: LightMap, depths: np.ndarray, ways: np.ndarray, bias: np.ndarray
) -> np.ndarray:
    """1 where a receiver is the first in its texel or off the map, else 0: (n,) float32."""
    texels = light_map.texels_of(ways)
    first = np.where(texels < 0, np.float32(np.inf), depths[texels])
    return (distances_of(ways) <= first + bias).astype(np.float32)


def disc_visibility(
    light_map: LightMap,
    depths: np.ndarray,
    ways: np.ndarray,
    normals: np.ndarray,
    bias: np.ndarray,
    *,
    texels: float,
    samples: int,
    keys: np.ndarray,
) -> np.ndarray:
    """Percentage-closer filtering over a disc of so many texels' radius, (n,) float32.

    Args:
        ways: (n, 3) from the light to receivers; normals: (n, 3), geometric; bias: (n,).
    """
    angle = texels * 2 * light_map.half / light_map.resolution
    found = np.empty(len(ways), np.float32)
    disc, seen = vogel_disc(samples), looked_up(light_map, depths)
    _fill_even(ways, normals, bias, angle, disc, keys, *seen, found)
    return found


def soft_disc_visibility(
    light_map: LightMap,
    depths: np.ndarray,
    ways: np.ndarray,
    normals: np.ndarray,
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
        ways: (n, 3) from the light to receivers; normals: (n, 3), geometric; bias: (n,).
        searched, samples: of the search and of the filter, 64 and 128 (Hu et al. 2025, 6.1).
    """
    discs = vogel_disc(searched), vogel_disc(samples)
    found = np.empty(len(ways), np.float32)
    seen = looked_up(light_map, depths)
    _fill_soft(ways, normals, bias, float(radius), nearest, discs, keys, *seen, found)
    return found


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_even(
    ways, normals, bias, angle, disc, keys, depths, projections, faces, half, resolution, visibility
):
    """Share of a disc's directions whose texels do not hide the receiver."""
    for i in range(len(ways)):
        receiver = _receiver(ways, normals, bias, i)
        u, v = across(*receiver[0], keys[i])
        hidden, _ = blockers(
            disc, receiver, u, v, angle, depths, projections, faces, half, resolution
        )
        visibility[i] = 1 - hidden / disc.shape[1]


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_soft(
    ways,
    normals,
    bias,
    radius,
    nearest,
    discs,
    keys,
    depths,
    projections,
    faces,
    half,
    resolution,
    visibility,
):
    """The same of discs as wide as the penumbra that the blockers in a first disc make."""
    searched, disc = discs
    for i in range(len(ways)):
        receiver = _receiver(ways, normals, bias, i)
        distance = receiver[1]
        u, v = across(*receiver[0], keys[i])
        widest = radius * (1 / (nearest * distance) - 1 / distance)
        hidden, total = blockers(
            searched, receiver, u, v, widest, depths, projections, faces, half, resolution
        )
        if not hidden:
            visibility[i] = 1
            continue
        blocker = total / hidden
        angle = radius * (distance - blocker) / (distance * blocker)
        angle = max(angle, half / resolution)  # half a texel: no narrower than that
        hidden, _ = blockers(
            disc, receiver, u, v, angle, depths, projections, faces, half, resolution
        )
        visibility[i] = 1 - hidden / disc.shape[1]


@njit(cache=True, nogil=True, error_model="numpy")
def _receiver(ways, normals, bias, i):
    """A receiver as `blockers` takes it, in float64."""
    x, y, z = np.float64(ways[i, 0]), np.float64(ways[i, 1]), np.float64(ways[i, 2])
    distance = np.sqrt(x * x + y * y + z * z)
    normal = np.float64(normals[i, 0]), np.float64(normals[i, 1]), np.float64(normals[i, 2])
    return (x / distance, y / distance, z / distance), distance, np.float64(bias[i]), normal
