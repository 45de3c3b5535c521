"""The buffers of a frame: what screen-space methods are told of each pixel.

Lengths are in shares of the scene's size S, distances are radial. Channels, in this order:

- `z`: from the light to the point; `gap`: how much farther the map's texel is, z_map − z;
- `d`: from the eye to the point;
- `c_e`, `c_v`: cosines of the normal with the ways to light and eye;
- `agreement`: cosine between the point's normal and that of what the map's texel shows;
- `hard`, `pcf`, `msm`: visibility by that texel, by 2 × 2 of them, and by the four moments of 3 × 3
  (σ 0.55, as the maps of Hu et al. 2025 seem to have), the first two with the bias that all maps have.
  Moments have none: their variance takes a slope for what it is, and a bias lets light leak;
- `n_x`, `n_y`, `n_z`: the normal, in the scene's axes, on the camera's side;
- `e_x`, `e_y`, `e_z`: that of what the map's texel shows, on the light's side, in the same axes.

Where the map shows nothing, or the point lies outside it, `gap` is 0, `agreement` 1 and the texel's
normal the point's own. A pixel without a surface has zeros, and visibilities of 1.
"""

from collections.abc import Collection
from functools import cached_property

import numpy as np
from numba import njit

from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.scene import Scene
from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.moments import gaussian, hamburger_visibility
from neural_shadows.shadow_maps.neighbourhood import neighbourhood

_NORMAL, _SHOWN = ("n_x", "n_y", "n_z"), ("e_x", "e_y", "e_z")
CHANNELS = (
    *("z", "gap", "d", "c_e", "c_v", "agreement", "hard", "pcf", "msm"),
    *_NORMAL,
    *_SHOWN,
)
LIT = ("hard", "pcf", "msm")  # 1 where there is no surface
_KERNEL = gaussian(3, 0.55)


def buffers_of(scene: Scene, surface: Surface, light_map: LightMap) -> np.ndarray:
    """All channels of a frame, (channels, height, width) float16.

    Only the texels that its points look up are traced.
    """
    images = channel_images(CHANNELS, _TracedFrame(scene, surface, light_map.centre, light_map))
    return np.stack([images[name].astype(np.float16) for name in CHANNELS])


def channel_images(names: Collection[str], frame: SoftFrame) -> dict[str, np.ndarray]:
    """Some channels of a frame by name, (height, width) float32, from its points and its light's map."""
    size, ways, normal = frame.scene.size, frame.ways, frame.surface.n
    z = np.linalg.norm(ways, axis=1)
    eye = frame.surface.camera.eye.astype(np.float32) - frame.surface.p
    d = np.linalg.norm(eye, axis=1)
    nearest = frame.light_map.texels_of(ways)
    first = np.where(nearest >= 0, np.take(frame.depths, nearest), np.float32(np.inf))
    known, behind = np.isfinite(first), z - frame.bias
    lit = {"hard": behind <= first} | _filtered({*names}, frame, behind)
    values = {
        "z": z / size,
        "gap": np.where(known, first - z, 0) / size,
        "d": d / size,
        "c_e": -np.einsum("ij,ij->i", ways, normal) / z,
        "c_v": np.einsum("ij,ij->i", eye, normal) / d,
        **{name: value * (frame.cosines > 0) for name, value in lit.items()},
        **dict(zip(_NORMAL, normal.T)),
    }
    if not values.keys() >= {*names}:
        shown = _shown_normals(frame, nearest, known)
        values["agreement"] = np.where(known, np.einsum("ij,ij->i", normal, shown), 1)
        values |= zip(_SHOWN, shown.T)
    images = frame.surface.image
    return {name: images(values[name].astype(np.float32), float(name in LIT)) for name in names}


def _filtered(
    names: Collection[str], frame: SoftFrame, behind: np.ndarray
) -> dict[str, np.ndarray]:
    """`pcf` and `msm`, whichever is named, (n,): of receivers at distances `behind`."""
    if not {"pcf", "msm"} & names:
        return {}
    reach = int("msm" in names)
    texels, fractions = neighbourhood(frame.light_map, frame.ways, reach)
    found = {}
    if "pcf" in names:
        inner = texels[:, reach : reach + 2, reach : reach + 2]
        first = np.where(inner >= 0, np.take(frame.depths, inner), np.float32(np.inf))
        right, down = (np.stack([1 - one, one], axis=1) for one in fractions.T)
        tests = behind[:, None, None] <= first
        found["pcf"] = np.einsum("ni,nj,nij->n", down, right, tests)
    if "msm" in names:
        moments, far = np.empty((len(texels), 4)), 2 * frame.scene.size
        distances = np.linalg.norm(frame.ways, axis=1)
        _fill_moments(frame.depths, texels, fractions, _KERNEL, far, moments)
        found["msm"] = hamburger_visibility(moments, distances / far)
    return found


def _shown_normals(frame: SoftFrame, nearest: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Of what texels show, on the light's side, (n, 3) float32; the points' own where unknown."""
    shown = np.take(frame.scene.joined.face_normals, np.take(frame.shown, nearest), axis=0)
    inner = np.einsum("ij,ij->i", shown, frame.ways) > 0
    shown = np.where(inner[:, None], -shown, shown)
    return np.where(known[:, None], shown, frame.surface.n)


class _TracedFrame(SoftFrame):
    """A frame whose map has those texels alone that its points look up, by rays."""

    @cached_property
    def _hits(self) -> tuple[np.ndarray, np.ndarray]:
        texels, _ = neighbourhood(self.light_map, self.ways, reach=1)
        return self.traced(np.append(texels.ravel(), self.light_map.texels_of(self.ways)))

    @cached_property
    def depths(self) -> np.ndarray:
        return self._hits[0]

    @cached_property
    def shown(self) -> np.ndarray:
        return self._hits[1]


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_moments(depths, texels, fractions, kernel, far, moments):
    """Four powers of depth over 3 × 3 texels round each of four, bilinear between them: (n, 4) float64.

    Of `neighbourhood`: texels (n, 4, 4), −1 for none, and fractions (n, 2).
    """
    # In float64: of weights that sum to one but for a rounding the fourth moment makes nonsense.
    rows, columns = np.empty(4), np.empty(4)
    for i in range(len(texels)):
        rows[:], columns[:] = 0, 0
        right, down = fractions[i, 0], fractions[i, 1]
        for k in range(3):
            rows[k] += (1 - down) * kernel[k]
            rows[k + 1] += down * kernel[k]
            columns[k] += (1 - right) * kernel[k]
            columns[k + 1] += right * kernel[k]
        one = two = three = four = 0.0
        for j in range(4):
            for k in range(4):
                texel = texels[i, j, k]
                q = min(np.float64(depths[texel]), far) / far if texel >= 0 else 1.0
                weight = rows[j] * columns[k]
                weight *= q
                one += weight
                weight *= q
                two += weight
                weight *= q
                three += weight
                weight *= q
                four += weight
        moments[i, 0], moments[i, 1], moments[i, 2], moments[i, 3] = one, two, three, four
