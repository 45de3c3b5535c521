"""Visibility by a light map: hard, filtered, and by blocker search.

Percentage-closer filtering (Reeves et al. 1987) and percentage-closer soft shadows (Fernando 2005),
with a kernel as wide as the penumbra of its blockers. Kernels are discs of directions
round the receiver's, so that they go on from face to face of a cube.
"""

import numpy as np
from numba import njit

from neural_shadows.rendering.lengths import lengths_of
from neural_shadows.shadow_maps.light_discs import across, blockers, looked_up, vogel_disc
from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.slope import slope


def receiver_bias(
    light_map: LightMap,
    from_light: np.ndarray,
    cosines: np.ndarray,
    scene_size: float,
    reach: float = 0.75,
) -> np.ndarray:
    """Depth bias of receivers, (n,) float32.

    h · `slope` + 1e-4 of the scene's size, h the width of a texel at the receiver, the slope by its geometric
    normal: as directional maps have it.

    Args:
        from_light: (n, 3) from the light to receivers; cosines: (n,), see `slope`.
        reach: see `slope`; of a filtered map the filter's, too (a cone bias).
    """
    distance = lengths_of(from_light)
    texel = light_map.texel_size(from_light / distance[:, None]) * distance
    return (texel * slope(cosines, reach) + 1e-4 * scene_size).astype(np.float32)


def hard_visibility(
    light_map: LightMap, depths: np.ndarray, from_light: np.ndarray, bias: np.ndarray
) -> np.ndarray:
    """Hard visibility by one texel, 1 off the map: (n,) float32."""
    texels = light_map.texels_of(from_light)
    first = np.where(texels < 0, np.float32(np.inf), depths[texels])
    return (lengths_of(from_light) <= first + bias).astype(np.float32)


def disc_visibility(
    light_map: LightMap,
    depths: np.ndarray,
    from_light: np.ndarray,
    normals: np.ndarray,
    bias: np.ndarray,
    *,
    texels: float,
    samples: int,
    keys: np.ndarray,
) -> np.ndarray:
    """Percentage-closer filtering over a disc, (n,) float32.

    Args:
        from_light: (n, 3) from the light to receivers; normals: (n, 3), geometric; bias: (n,).
        texels: radius of the disc.
    """
    angle = texels * 2 * light_map.half / light_map.resolution
    visibility = np.empty(len(from_light), np.float32)
    disc, map_arguments = vogel_disc(samples), looked_up(light_map, depths)
    _fill_even(from_light, normals, bias, angle, disc, keys, map_arguments, visibility)
    return visibility


def soft_disc_visibility(
    light_map: LightMap,
    depths: np.ndarray,
    from_light: np.ndarray,
    normals: np.ndarray,
    bias: np.ndarray,
    *,
    radius: float,
    searched: int = 64,
    samples: int = 128,
    nearest: float = 0.5,
    keys: np.ndarray,
) -> np.ndarray:
    """Percentage-closer soft shadows of a light of a radius, (n,) float32.

    Blockers are searched from `nearest` of the way from the map's `near` to the receiver on. Of the way
    from the light itself, a sun's search would always span the scene. Their mean distance z̄ determines
    the width of the penumbra: the light's radius seen from the receiver, at z̄.

    Args:
        from_light: (n, 3) from the light to receivers; normals: (n, 3), geometric; bias: (n,).
        searched, samples: of the search and of the filter, 64 and 128 (Hu et al. 2025, 6.1).
    """
    discs = vogel_disc(searched), vogel_disc(samples)
    visibility = np.empty(len(from_light), np.float32)
    receivers, map_arguments = (from_light, normals, bias), looked_up(light_map, depths)
    widths = float(radius), nearest, light_map.near
    _fill_soft(*receivers, *widths, discs, keys, map_arguments, visibility)
    return visibility


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_even(from_light, normals, bias, angle, disc, keys, looked_up_in, visibility):
    """Unblocked share of a disc's directions; 0 of receivers that face away."""
    depths, projections, faces, half, resolution = looked_up_in
    for i in range(len(from_light)):
        receiver = _receiver(from_light, normals, bias, i)
        if _faces_away(receiver):
            visibility[i] = 0
            continue
        u, v = across(*receiver[0], keys[i])
        hidden, _ = blockers(
            disc, receiver, u, v, angle, depths, projections, faces, half, resolution
        )
        visibility[i] = 1 - hidden / disc.shape[1]


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_soft(
    from_light, normals, bias, radius, nearest, near, discs, keys, looked_up_in, visibility
):
    """Unblocked share of discs as wide as the blockers' penumbra; 0 of receivers that face away."""
    depths, projections, faces, half, resolution = looked_up_in
    searched, disc = discs
    for i in range(len(from_light)):
        receiver = _receiver(from_light, normals, bias, i)
        if _faces_away(receiver):
            visibility[i] = 0
            continue
        distance = receiver[1]
        u, v = across(*receiver[0], keys[i])
        first = near + nearest * max(distance - near, 0)
        widest = radius * (1 / first - 1 / distance)
        hidden, total = blockers(
            searched, receiver, u, v, widest, depths, projections, faces, half, resolution
        )
        if not hidden:
            visibility[i] = 1
            continue
        blocker = total / hidden
        angle = radius * (distance - blocker) / (distance * blocker)
        angle = max(angle, half / resolution)  # at least half a texel
        hidden, _ = blockers(
            disc, receiver, u, v, angle, depths, projections, faces, half, resolution
        )
        visibility[i] = 1 - hidden / disc.shape[1]


@njit(cache=True, nogil=True)
def _faces_away(receiver):
    direction, _, _, normal = receiver
    return direction[0] * normal[0] + direction[1] * normal[1] + direction[2] * normal[2] >= 0


@njit(cache=True, nogil=True, error_model="numpy")
def _receiver(from_light, normals, bias, i):
    """The receiver argument of `blockers`, in float64."""
    x, y, z = (
        np.float64(from_light[i, 0]),
        np.float64(from_light[i, 1]),
        np.float64(from_light[i, 2]),
    )
    distance = np.sqrt(x * x + y * y + z * z)
    normal = np.float64(normals[i, 0]), np.float64(normals[i, 1]), np.float64(normals[i, 2])
    return (x / distance, y / distance, z / distance), distance, np.float64(bias[i]), normal
