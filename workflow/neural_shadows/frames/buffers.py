"""The buffers of a frame: what screen-space methods are told of each pixel.

Lengths are in shares of the scene's size S, distances are radial. Channels, in this order:

- `z`: from the light to the point; `gap`: how much farther the map's texel is, z_map − z;
- `d`: from the eye to the point;
- `c_e`, `c_v`: cosines of the normal with the ways to light and eye;
- `agreement`: cosine between the point's normal and that of what the map's texel shows;
- `hard`, `pcf`, `msm`: visibility by that texel, by 2 × 2 of them, and by the four moments of 3 × 3
  (σ 0.55, as the maps of Hu et al. 2025 seem to have), with the bias that all maps have;
- `n_x`, `n_y`, `n_z`: the normal, in the scene's axes, on the camera's side;
- `e_x`, `e_y`, `e_z`: that of what the map's texel shows, on the light's side, in the same axes.

Where the map shows nothing, or the point lies outside it, `gap` is 0, `agreement` 1 and the texel's
normal the point's own. A pixel without a surface has zeros, and visibilities of 1.
"""

import numpy as np
from numba import njit

from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.scene import Scene
from neural_shadows.shadow_maps.light_filters import receiver_bias
from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.moments import gaussian, hamburger_visibility
from neural_shadows.shadow_maps.neighbourhood import neighbourhood

CHANNELS = (
    *("z", "gap", "d", "c_e", "c_v", "agreement", "hard", "pcf", "msm"),
    *("n_x", "n_y", "n_z"),
    *("e_x", "e_y", "e_z"),
)
LIT = ("hard", "pcf", "msm")  # 1 where there is no surface
_KERNEL = gaussian(3, 0.55)


def buffers_of(scene: Scene, surface: Surface, light_map: LightMap) -> np.ndarray:
    """All channels of a frame, (channels, height, width) float16.

    Only the texels that its points look up are traced.
    """
    size, normal = scene.size, surface.n
    ways = surface.p - light_map.centre.astype(np.float32)
    z = np.linalg.norm(ways, axis=1)
    eye = surface.camera.eye.astype(np.float32) - surface.p
    d = np.linalg.norm(eye, axis=1)
    geometric = -np.einsum("ij,ij->i", ways, surface.n_g) / z
    behind = z - receiver_bias(light_map, ways, geometric, size)
    nearest = light_map.texels_of(ways)
    texels, weights = neighbourhood(light_map, ways, reach=1)
    depths, faces = _traced(scene, light_map, np.append(texels.ravel(), nearest))
    known = (nearest >= 0) & np.isfinite(depths[nearest])
    shown = np.take(scene.joined.face_normals, faces[nearest], axis=0)
    inner = np.einsum("ij,ij->i", shown, ways) > 0
    shown = np.where(inner[:, None], -shown, shown)  # on the light's side
    shown = np.where(known[:, None], shown, normal)
    first = np.where(texels >= 0, depths[texels], np.float32(np.inf))
    lit = {
        "hard": behind <= np.where(known, depths[nearest], np.float32(np.inf)),
        "pcf": np.einsum("nij,nij->n", weights, (behind[:, None, None] <= first)),
        "msm": _by_moments(first, weights, behind, 2 * size),
    }
    values = {
        "z": z / size,
        "gap": np.where(known, depths[nearest] - z, 0) / size,
        "d": d / size,
        "c_e": -np.einsum("ij,ij->i", ways, normal) / z,
        "c_v": np.einsum("ij,ij->i", eye, normal) / d,
        "agreement": np.where(known, np.einsum("ij,ij->i", normal, shown), 1),
        **{name: value * (geometric > 0) for name, value in lit.items()},
        **dict(zip(("n_x", "n_y", "n_z", "e_x", "e_y", "e_z"), [*normal.T, *shown.T])),
    }
    images = (surface.image(values[name], float(name in LIT)) for name in CHANNELS)
    return np.stack([image.astype(np.float16) for image in images])


def _traced(scene: Scene, light_map: LightMap, texels: np.ndarray):
    """Depths and faces by texel, of the whole map; only these texels' are known."""
    asked = np.zeros(light_map.count, bool)
    asked[texels[texels >= 0]] = True
    some = np.flatnonzero(asked)
    # Of zeros, only the pages that are written take memory and time.
    depths, faces = np.zeros(light_map.count, np.float32), np.zeros(light_map.count, np.int32)
    depths[some], faces[some] = light_map.first_hits(scene.tracer, some)
    return depths, faces


def _by_moments(first: np.ndarray, weights: np.ndarray, behind: np.ndarray, far: float):
    """Visibility (n,) by the moments of 3 × 3 texels, bilinear between them.

    Args:
        first: (n, 4, 4) distances in the texels; weights: of the bilinear look-up.
    """
    moments = np.empty((len(first), 4))
    _fill_moments(first, weights, _KERNEL, far, moments)
    return hamburger_visibility(moments, behind / far)


@njit(cache=True, nogil=True)
def _fill_moments(first, weights, kernel, far, moments):
    """Four powers of depth over 3 × 3 texels round each of four, by their weights: (n, 4) float64."""
    # In float64: of weights that sum to one but for a rounding the fourth moment makes nonsense.
    for i in range(len(first)):
        rows, columns = np.zeros(4), np.zeros(4)
        for j in (1, 2):
            for k in range(3):
                rows[j + k - 1] += (weights[i, j, 1] + weights[i, j, 2]) * kernel[k]
                columns[j + k - 1] += (weights[i, 1, j] + weights[i, 2, j]) * kernel[k]
        one = two = three = four = 0.0
        for j in range(4):
            for k in range(4):
                q = min(np.float64(first[i, j, k]), far) / far
                weight = rows[j] * columns[k]
                one += weight * q
                two += weight * q * q
                three += weight * q * q * q
                four += weight * q * q * q * q
        moments[i, 0], moments[i, 1], moments[i, 2], moments[i, 3] = one, two, three, four
