"""The buffers of a frame: what screen-space methods are told of each pixel.

Lengths are in shares of the scene's size S, distances are radial. Channels, in this order:

- `z`: from the light to the point; `gap`: how much farther the map's texel is, z_map − z;
- `d`: from the eye to the point;
- `c_e`, `c_v`: cosines of the normal with the ways to light and eye;
- `agreement`: cosine between the point's normal and that of what the map's texel shows;
- `hard`, `pcf`, `msm`: visibility by that texel, by 2 × 2 of them, and by the four moments of 3 × 3
  (σ 0.55, as the maps of Hu et al. 2025 seem to have), with the bias that all maps have;
- `n_x`, `n_y`, `n_z`: the normal.

Where the map shows nothing, or the point lies outside it, `gap` is 0 and `agreement` 1. A pixel
without a surface has zeros, and visibilities of 1.
"""

import numpy as np

from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.scene import Scene
from neural_shadows.shadow_maps.light_filters import receiver_bias
from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.moments import gaussian, hamburger_visibility, powers
from neural_shadows.shadow_maps.neighbourhood import neighbourhood

CHANNELS = (
    *("z", "gap", "d", "c_e", "c_v", "agreement", "hard", "pcf", "msm"),
    *("n_x", "n_y", "n_z"),
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
    shown *= -np.sign(np.einsum("ij,ij->i", shown, ways))[:, None]  # on the light's side
    agreement = np.einsum("ij,ij->i", normal, shown)
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
        "agreement": np.where(known, agreement, 1),
        **{name: value * (geometric > 0) for name, value in lit.items()},
        **dict(zip(("n_x", "n_y", "n_z"), normal.T)),
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
    # In float64: of weights that sum to one but for a rounding the fourth moment makes nonsense.
    rows, columns = (weights.sum(axis) for axis in (2, 1))
    spread = [
        sum(_KERNEL[k] * np.roll(one, k - 1, axis=1) for k in range(3)) for one in (rows, columns)
    ]
    q = np.minimum(first, far) / far
    moments = np.einsum("ni,nj,nijk->nk", *spread, powers(q, 4), optimize=True)
    return hamburger_visibility(moments, behind / far)
