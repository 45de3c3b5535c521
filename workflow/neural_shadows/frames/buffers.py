"""The buffers of a frame: per-pixel inputs of screen-space methods.

Lengths are in shares of the scene's size S, distances are radial. Channels, in this order:

- `z`: from the light, of a sun from its map's `near`, to the point; `gap`: the map's depth minus z,
  z_map − z;
- `d`: from the eye to the point;
- `c_e`, `c_v`: cosines of the normal with the directions to light and eye;
- `agreement`: cosine between the point's normal and that of the map's surface;
- `hard`, `pcf`, `msm`: visibility by that texel, by 2 × 2 of them, and by the four moments of 3 × 3
  (σ 0.55, as the maps of Hu et al. 2025 seem to have), the first two with the bias that all maps have.
  Moments have none: their variance accounts for slopes, and a bias would leak light;
- `n_x`, `n_y`, `n_z`: the normal, in the scene's axes, on the camera's side;
- `e_x`, `e_y`, `e_z`: the normal of the map's surface, on the light's side, in the same axes.

Where the map shows nothing, or the point lies outside it, `gap` is 0, `agreement` 1 and the texel's
normal the point's own. A pixel without a surface has zeros, and visibilities of 1.
"""

from collections.abc import Collection
from functools import cached_property

import numpy as np
from numba import njit

from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.lengths import lengths_and_cosines, lengths_of
from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.scene import Scene
from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.moments import gaussian, hamburger_visibility
from neural_shadows.shadow_maps.neighbourhood import neighbourhood

_NORMAL, _MAP_NORMAL = ("n_x", "n_y", "n_z"), ("e_x", "e_y", "e_z")
CHANNELS = (
    *("z", "gap", "d", "c_e", "c_v", "agreement", "hard", "pcf", "msm"),
    *_NORMAL,
    *_MAP_NORMAL,
)
LIT = ("hard", "pcf", "msm")  # 1 where there is no surface
_KERNEL = gaussian(3, 0.55)
# Ranges of values, with room for the rounding of half floats.
VISIBLE = (-0.001, 1.001)
LIMITS = {
    **dict.fromkeys(("z", "d"), (0, np.inf)),
    **dict.fromkeys(("c_e", "c_v", "agreement", *_NORMAL, *_MAP_NORMAL), (-1.01, 1.01)),
    **dict.fromkeys(LIT, VISIBLE),
}


def out_of_range(values: np.ndarray, low: float, high: float) -> str:
    """How a user's values leave their range, for an error; empty if they do not."""
    if not values.size or (low <= values.min() and values.max() <= high):
        return ""
    range_ = "0 or more" if high == np.inf else f"in [{round(low)}, {round(high)}]"
    return f"from {values.min():g} to {values.max():g}; should be {range_}"


def buffers_of(scene: Scene, surface: Surface, light_map: LightMap) -> np.ndarray:
    """Compute all channels of a frame, (channels, height, width) float16.

    Only the looked-up texels are traced.
    """
    images = channel_images(CHANNELS, _TracedFrame(scene, surface, light_map.centre, light_map))
    return np.stack([images[name].astype(np.float16) for name in CHANNELS])


def channel_images(names: Collection[str], frame: SoftFrame) -> dict[str, np.ndarray]:
    """Compute the named channels of a frame, (height, width) float32."""
    size, from_light, normal = frame.scene.size, frame.from_light, frame.surface.n
    z, from_behind = lengths_and_cosines(from_light, normal)
    to_eye = frame.surface.camera.eye.astype(np.float32) - frame.surface.p
    d, c_v = lengths_and_cosines(to_eye, normal)
    values = {
        "z": (z - np.float32(frame.light_map.near)) / size,
        "d": d / size,
        "c_e": -from_behind,
        "c_v": c_v,
        **dict(zip(_NORMAL, normal.T)),
    }
    if not values.keys() >= {*names}:  # a network of rays needs no map
        values |= _of_map({*names}, frame, z)
    image = frame.surface.image
    return {name: image(values[name].astype(np.float32), float(name in LIT)) for name in names}


def _of_map(names: set[str], frame: SoftFrame, z: np.ndarray) -> dict[str, np.ndarray]:
    """Compute channels of the light map, (n,) each; those of its normals if named."""
    nearest = frame.light_map.texels_of(frame.from_light)
    first = np.where(nearest >= 0, np.take(frame.depths, nearest), np.float32(np.inf))
    occupied, biased_z = np.isfinite(first), z - frame.bias
    lit = {"hard": biased_z <= first} | _filtered(names, frame, biased_z)
    values = {
        "gap": np.where(occupied, first - z, 0) / frame.scene.size,
        **{name: value * (frame.cosines > 0) for name, value in lit.items()},
    }
    if {"agreement", *_MAP_NORMAL} & names:
        normal, map_normals = frame.surface.n, _map_normals(frame, nearest, occupied)
        values["agreement"] = np.where(occupied, np.einsum("ij,ij->i", normal, map_normals), 1)
        values |= zip(_MAP_NORMAL, map_normals.T)
    return values


def _filtered(
    names: Collection[str], frame: SoftFrame, biased_z: np.ndarray
) -> dict[str, np.ndarray]:
    """Compute `pcf` and `msm` if named, (n,), at biased distances `biased_z`."""
    if not {"pcf", "msm"} & names:
        return {}
    reach = int("msm" in names)
    texels, fractions = neighbourhood(frame.light_map, frame.from_light, reach)
    visibility = {}
    if "pcf" in names:
        inner = texels[:, reach : reach + 2, reach : reach + 2]
        first = np.where(inner >= 0, np.take(frame.depths, inner), np.float32(np.inf))
        right, down = (np.stack([1 - share, share], axis=1) for share in fractions.T)
        tests = biased_z[:, None, None] <= first
        visibility["pcf"] = np.einsum("ni,nj,nij->n", down, right, tests)
    if "msm" in names:
        near, span = frame.light_map.near, 2 * frame.scene.size
        moments = np.empty((len(texels), 4))
        distances = lengths_of(frame.from_light)
        _fill_moments(frame.depths, texels, fractions, _KERNEL, (near, span), moments)
        visibility["msm"] = hamburger_visibility(moments, (distances - np.float32(near)) / span)
    return visibility


def _map_normals(frame: SoftFrame, nearest: np.ndarray, occupied: np.ndarray) -> np.ndarray:
    """Normals of the map's surfaces, on the light's side, (n, 3) float32.

    Where a texel is empty, the point's own.
    """
    normals = np.take(frame.scene.joined.face_normals, np.take(frame.shown, nearest), axis=0)
    averted = np.einsum("ij,ij->i", normals, frame.from_light) > 0
    normals = np.where(averted[:, None], -normals, normals)
    return np.where(occupied[:, None], normals, frame.surface.n)


class _TracedFrame(SoftFrame):
    """A frame with a map of its looked-up texels alone, by rays."""

    @cached_property
    def _hits(self) -> tuple[np.ndarray, np.ndarray]:
        texels, _ = neighbourhood(self.light_map, self.from_light, reach=1)
        return self.traced(np.append(texels.ravel(), self.light_map.texels_of(self.from_light)))

    @cached_property
    def depths(self) -> np.ndarray:
        return self._hits[0]

    @cached_property
    def shown(self) -> np.ndarray:
        return self._hits[1]


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_moments(depths, texels, fractions, kernel, depth_range, moments):
    """Filter four powers of depth over 3 × 3 texels, bilinearly: (n, 4) float64.

    From `neighbourhood`: texels (n, 4, 4), −1 for none, and fractions (n, 2). Depth is 0 at the
    first of `depth_range`, and 1 as far behind it as the second.
    """
    # In float64: rounded weights that do not sum to one spoil the fourth moment.
    near, span = depth_range
    rows, columns = np.empty(4), np.empty(4)
    for i in range(len(texels)):
        for k in range(4):
            rows[k] = columns[k] = 0.0
        right, down = fractions[i, 0], fractions[i, 1]
        for k in range(3):
            rows[k] += (1 - down) * kernel[k]
            rows[k + 1] += down * kernel[k]
            columns[k] += (1 - right) * kernel[k]
            columns[k + 1] += right * kernel[k]
        m1 = m2 = m3 = m4 = 0.0
        for j in range(4):
            for k in range(4):
                texel = texels[i, j, k]
                q = min(np.float64(depths[texel]) - near, span) / span if texel >= 0 else 1.0
                weight = rows[j] * columns[k]
                weight *= q
                m1 += weight
                weight *= q
                m2 += weight
                weight *= q
                m3 += weight
                weight *= q
                m4 += weight
        moments[i, 0], moments[i, 1], moments[i, 2], moments[i, 3] = m1, m2, m3, m4
