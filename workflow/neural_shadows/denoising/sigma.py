"""A shadow denoiser like NRD's SIGMA: blurred by distances to blockers.

After what is described of NVIDIA's Real-Time Denoisers (4.18), whose code was not used. "Like",
because surfaces turned from the light are blurred like all others (errors were a sixth smaller),
and the undescribed weights are ours. All on one thread.
"""

import numpy as np
from numba import njit
from scipy.ndimage import uniform_filter

from neural_shadows.denoising.history import History
from neural_shadows.denoising.mixed_blocks import SIDE, Neighbourhoods
from neural_shadows.rendering.reprojection import Reprojection
from neural_shadows.rendering.surface import Surface

REACH = 0.7  # radius of the sparse taps, in shares of a penumbra's
PASSES = 2
_NEAR = 2  # pixels of dense taps to each side
_TAPS = 12  # sparse ones
_SHORT = np.float32(2)  # pixels of radius up to which a pixel keeps a part of its own visibility
_LONG = np.float32(32)  # pixels that sparse taps reach at most
_DENSE = np.float32(8)  # weight of the dense taps' mean; of 2, 4, 8 and 16 about the best
_PLANE = np.float32(2)  # pixels off a pixel's own plane, from which on others weigh nothing
_LEAST = np.float32(1e-12)
SHARE = 0.125  # the least of a new frame: of seven of history
CLAMP = 3.0  # standard deviations of 5 × 5 pixels to which history is clamped


def _gaussian(r: np.ndarray) -> np.ndarray:
    """Weight by distance, in shares of the reach."""
    return np.float32(np.exp(-0.66 * r * r))


def _disc() -> np.ndarray:
    """Sparse taps on the unit disc (Vogel): x, y, weight, (taps, 3) float32."""
    k = np.arange(_TAPS)
    r, angle = np.sqrt((k + 0.5) / _TAPS), k * np.pi * (3 - 5**0.5)
    return np.float32(np.stack([r * np.cos(angle), r * np.sin(angle), _gaussian(r)], axis=1))


_DISC = _disc()
_SQUARE = _gaussian(np.hypot(*np.mgrid[: _NEAR + 1, : _NEAR + 1]) / _NEAR)


class SigmaFilter:
    """The filter for pictures (height, width); keeps its buffers, so one thread may use it.

    Args:
        reach: see REACH.
        alone: also smooth pixels without a blocker nearby. Their noise is of the light's part below their
            horizon; a filter after this one leaves up to a third less if it smooths that itself.
    """

    def __init__(self, height: int, width: int, reach: float = REACH, alone: bool = True):
        self._alone = alone
        self.reach = reach
        self._nearby = Neighbourhoods(height, width)
        self._guides = np.zeros((7, height, width), np.float32)
        self._images = np.empty((6, height, width), np.float32)

    def see(self, place: np.ndarray, normal: np.ndarray, pixel: np.ndarray) -> None:
        """Set the surface guiding the weights.

        Args:
            place, normal: (H, W, 3) float32, of its points and of their faces, in the scene's unit.
            pixel: (H, W) float32, a pixel's side at the point; 0 where there is no surface.
        """
        self._guides[:3] = np.moveaxis(place, 2, 0)
        self._guides[3:6] = np.moveaxis(normal, 2, 0)
        self._guides[6] = pixel

    def smooth(self, visibility: np.ndarray, penumbra: np.ndarray, turned: int = 0) -> np.ndarray:
        """Smooth a picture (H, W) float32 by both passes.

        Args:
            visibility: (H, W) float32 in [0, 1].
            penumbra: (H, W) float32, the mean radius of the penumbrae of the blockers of a pixel's
                rays, in the scene's unit; below 0 without blockers.
            turned: number of earlier turns of the sparse taps.
        """
        self._nearby.see(visibility)
        light, share, width, next_light, next_share, next_width = self._images
        pixel = self._guides[6]
        # Narrow ones weigh most: 1 / (1 + their radius in pixels), and 0 where there is none.
        light[:] = visibility
        share[:] = np.where(penumbra < 0, 0, pixel / (pixel + penumbra + _LEAST))
        width[:] = share * penumbra
        for image, after in zip(self._images[:3], self._images[3:]):
            after[:] = image
        for number in range(PASSES):
            _fill_next(
                self._guides,
                light,
                share,
                width,
                self._nearby.mixed,
                np.float32(self.reach),
                self._alone,
                PASSES * turned + number,
                next_light,
                next_share,
                next_width,
            )
            light, next_light = next_light, light
            share, next_share = next_share, share
            width, next_width = next_width, width
        return np.clip(light, 0, 1)

    def single(
        self,
        visibility: np.ndarray,
        penumbra: np.ndarray,
        surface: Surface,
        turned: int = 0,
        *,
        reach: float | None = None,
    ) -> np.ndarray:
        """Smooth a picture (H, W) float32 without history; see `smooth`. `reach`: from now on, if given."""
        self.reach = self.reach if reach is None else reach
        pixel = surface.depth_image() / np.float32(surface.camera.focal(surface.height))
        self.see(surface.image(surface.p), surface.image(surface.n_g), pixel)
        return self.smooth(visibility, penumbra, turned)


class TemporalSigma:
    """The filter for a sequence of frames (height, width), given one by one.

    The history is the output.

    Args:
        reach: see REACH. share: see SHARE. clamp: see CLAMP.
    """

    def __init__(
        self,
        height: int,
        width: int,
        reach: float = REACH,
        share: float = SHARE,
        clamp: float = CLAMP,
    ):
        self._frames, self._clamp = 1 / share - 1, clamp
        self._spatial = SigmaFilter(height, width, reach)
        self._history = History()  # the picture, and its number of frames
        self._frame = 0

    def next_frame(
        self,
        visibility: np.ndarray,
        penumbra: np.ndarray,
        surface: Surface,
        back: Reprojection | None = None,
    ) -> np.ndarray:
        """The next frame's picture, (H, W) float32.

        Args:
            visibility, penumbra: see `SigmaFilter.smooth`.
            back: to the frame before, None at first.
        """
        picture = self._spatial.single(visibility, penumbra, surface, self._frame)
        self._frame += 1
        pixels, (past, frames) = self._history.at(2, back)
        mean, deviation = (image.ravel()[pixels] for image in _nearby(picture))
        near = np.float32(self._clamp) * deviation
        clamped = np.clip(past, mean - near, mean + near)
        # Clamped history is of another shadow: its frames count as fewer.
        frames = 1 + np.minimum(frames, np.float32(self._frames)) * (1 - np.abs(past - clamped))
        new = np.stack([picture, np.ones_like(picture)])
        flat = new.reshape(2, -1)
        flat[0, pixels] = clamped + (flat[0, pixels] - clamped) / frames
        flat[1, pixels] = frames
        self._history.keep(new)
        return new[0].copy()


def _nearby(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means and standard deviations over 5 × 5 pixels, (H, W) float32 each."""
    mean, square = (uniform_filter(image, 2 * _NEAR + 1) for image in (picture, picture * picture))
    return mean, np.sqrt(np.maximum(square - mean * mean, 0))


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _fill_next(
    guides, light, share, width, mixed, reach, alone, turn, next_light, next_share, next_width
):
    """One pass over mixed blocks: dense taps, then sparse by penumbra."""
    height, columns = light.shape
    total, lights, shares, widths = np.empty((4, SIDE), np.float32)
    for y in range(height):
        for block in range(mixed.shape[1]):
            if not mixed[y, block]:
                continue
            begin, end = block * SIDE, min(block * SIDE + SIDE, columns)
            for i in range(SIDE):
                total[i], lights[i], shares[i], widths[i] = _LEAST, 0, 0, 0
            for v in range(max(0, y - _NEAR), min(height, y + _NEAR + 1)):
                for along in range(-_NEAR, _NEAR + 1):
                    x, last = max(begin, -along), min(end, columns - along)
                    if x >= last:
                        continue
                    _add_tap(
                        guides[:, y, x:last],
                        guides[:, v, x + along : last + along],
                        _SQUARE[abs(v - y), abs(along)],
                        light[v, x + along :],
                        share[v, x + along :],
                        width[v, x + along :],
                        total[x - begin :],
                        lights[x - begin :],
                        shares[x - begin :],
                        widths[x - begin :],
                    )
            for i in range(end - begin):
                x = begin + i
                if guides[6, y, x] <= 0:
                    continue
                dense = lights[i] / total[i]
                if shares[i] <= 0:  # no blocker nearby
                    next_light[y, x] = dense if alone else light[y, x]
                    continue
                next_light[y, x], next_share[y, x], next_width[y, x] = _spread(
                    guides, light, share, width, reach, turn, y, x, dense, widths[i] / shares[i]
                )


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _add_tap(guide, tap_guide, part, light, share, width, total, lights, shares, widths):
    """Add a run of taps weighted part · max(0, 1 − plane distance) · max(0, n·n')."""
    px, py, pz, nx, ny, nz, pixel = (
        guide[0],
        guide[1],
        guide[2],
        guide[3],
        guide[4],
        guide[5],
        guide[6],
    )
    qx, qy, qz, seen = tap_guide[0], tap_guide[1], tap_guide[2], tap_guide[6]
    mx, my, mz = tap_guide[3], tap_guide[4], tap_guide[5]
    none, one = np.float32(0), np.float32(1)
    for i in range(len(px)):
        away = abs(nx[i] * (qx[i] - px[i]) + ny[i] * (qy[i] - py[i]) + nz[i] * (qz[i] - pz[i]))
        weight = part * max(none, one - away / (_PLANE * pixel[i] + _LEAST))
        weight *= max(none, nx[i] * mx[i] + ny[i] * my[i] + nz[i] * mz[i])
        weight = weight if seen[i] > 0 else none
        total[i] += weight
        lights[i] += weight * light[i]
        shares[i] += weight * share[i]
        widths[i] += weight * width[i]


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _spread(guides, light, share, width, reach, turn, y, x, dense, penumbra):
    """A pixel's visibility, share and width from its dense mean and sparse taps round it."""
    height, columns = light.shape
    none, one, half = np.float32(0), np.float32(1), np.float32(0.5)
    px, py, pz, nx, ny, nz, pixel = guides[:, y, x]
    radius = reach * penumbra / pixel
    t = min(radius / _SHORT, one)
    mix = t * t * (3 - 2 * t)
    total = _DENSE
    lights = total * (light[y, x] + mix * (dense - light[y, x]))
    shares = total * pixel / (pixel + penumbra)
    widths = shares * penumbra
    cosine, sine = _turned(x, y, turn)
    radius = min(radius, _LONG)
    for k in range(_TAPS):
        u = int(np.floor(x + half + radius * (cosine * _DISC[k, 0] - sine * _DISC[k, 1])))
        v = int(np.floor(y + half + radius * (sine * _DISC[k, 0] + cosine * _DISC[k, 1])))
        if u < 0 or v < 0 or u >= columns or v >= height or guides[6, v, u] <= 0:
            continue
        qx, qy, qz = guides[0, v, u], guides[1, v, u], guides[2, v, u]
        away = abs(nx * (qx - px) + ny * (qy - py) + nz * (qz - pz))
        weight = _DISC[k, 2] * max(none, one - away / (_PLANE * pixel))
        weight *= max(none, nx * guides[3, v, u] + ny * guides[4, v, u] + nz * guides[5, v, u])
        if share[v, u] > 0:  # a narrower penumbra does not reach as far
            weight *= min(one, width[v, u] / (share[v, u] * penumbra + _LEAST))
        total += weight
        lights += weight * light[v, u]
        shares += weight * share[v, u]
        widths += weight * width[v, u]
    return lights / total, shares / total, widths / total


@njit(cache=True, nogil=True)
def _turned(x, y, turn):
    """Cosine and sine of a pixel's noise angle (Jimenez 2014)."""
    x, y = x + 5.588238 * turn, y + 5.588238 * turn
    angle = 2 * np.pi * ((52.9829189 * ((0.06711056 * x + 0.00583715 * y) % 1)) % 1)
    return np.float32(np.cos(angle)), np.float32(np.sin(angle))
