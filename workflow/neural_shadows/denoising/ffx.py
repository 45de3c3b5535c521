"""A shadow denoiser like FidelityFX's: passes of 3 × 3 taps, guided by the noise nearby.

After AMD's FidelityFX Denoiser for shadows (SDK 1.1). "Like", because a pixel may have any number of rays, and
the filter any number of passes; because how far depths may differ is a share of theirs; because a single picture's
variance is multiplied by 3 in place of 15; because with a history it is that of the pixels around, times the share
of the new frame, in place of that over frames; and because the power that ends it is left out: with it mean
squared errors were 6 to 8 % larger. All on one thread.
"""

from collections.abc import Iterator
from itertools import count

import numpy as np
from numba import njit

from neural_shadows.denoising.decay import decayed
from neural_shadows.denoising.history import History
from neural_shadows.denoising.mixed_blocks import SIDE, Neighbourhoods
from neural_shadows.denoising.trials import Trials, smooth
from neural_shadows.rendering.reprojection import Reprojection
from neural_shadows.rendering.surface import Surface

# Standard deviations a visibility may differ. In print 1, of a variance that is larger: `_NOISE` is 15 there.
SIGMA = 4.0
# Of a pixel's own depth, by how much another's may differ: of 0.01 to 1 the least error off edges.
SIGMA_DEPTH = np.float32(0.02)
PASSES = 3  # their taps 1, 2, 4 … pixels apart
_TAPS = np.array([1, 2 / 3], np.float32)  # by distance along an axis
_ASLANT = np.float32(0.5)  # cosines of normals below it weigh 0, not 2e-10: their power is 32
_LEAST = np.float32(1e-9)  # variance where there is none
_NOISE = 3  # what a single picture's variance is multiplied by
_LASTING = 8  # frames after which only `SHARE` of a frame is new
SHARE = 0.05  # the least of a new frame
CLAMP = 0.5  # standard deviations of its neighbourhood by which history may be off
_SURPRISE = 20.0  # squares of those, over which its count of frames falls to 1 / e


class FfxFilter:
    """The filter for pictures (height, width); keeps its buffers, so one thread may use it.

    Args:
        sigma: see SIGMA.
    """

    def __init__(self, height: int, width: int, sigma: float = SIGMA):
        self.sigma = sigma
        self._nearby = Neighbourhoods(height, width)
        self._guides = np.zeros((4, height, width), np.float32)
        self._images = np.empty((4, height, width), np.float32)

    def see(self, depth: np.ndarray, normal: np.ndarray) -> None:
        """See `PassFilter`."""
        self._guides[0] = depth
        self._guides[1:] = np.moveaxis(normal, 2, 0)

    def neighbourhood(self, visibility: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Gaussian means over 17 × 17 pixels, and variances: (H, W) float32.

        Args:
            visibility: (H, W) float32 in [0, 1]. Where it is 0 or 1 all around, the next `passes`
                leave the picture as it is.
        """
        self._nearby.see(visibility)
        mean = self._nearby.mean
        return mean, np.maximum(mean - mean * mean, 0)

    def noise(self, visibility: np.ndarray) -> np.ndarray:
        """See `PassFilter`."""
        return _NOISE * self.neighbourhood(visibility)[1]

    def passes(self, visibility: np.ndarray, variance: np.ndarray) -> Iterator[np.ndarray]:
        """See `PassFilter`."""
        light, spread, next_light, next_spread = self._images
        light[:], spread[:] = visibility, variance
        next_light[:], next_spread[:] = visibility, variance
        for step in count():
            _fill_next(
                self._guides,
                light,
                spread,
                self._nearby.mixed,
                np.float32(1 / self.sigma),
                1 << step,
                next_light,
                next_spread,
            )
            light, next_light = next_light, light
            spread, next_spread = next_spread, spread
            yield np.clip(light, 0, 1)

    def cleared(self) -> np.ndarray:
        """Pixels of blocks that are dark or lit all around in the last `neighbourhood`, (H, W) bool."""
        mixed = np.repeat(self._nearby.mixed, SIDE, axis=1)
        return ~mixed[:, : self._nearby.mean.shape[1]]


class FfxTrials(Trials):
    """Pictures (height, width) without history, by any constants."""

    def __init__(self, height: int, width: int):
        super().__init__(FfxFilter(height, width))

    def single(
        self,
        visibility: np.ndarray,
        surface: Surface,
        *,
        sigma: float = SIGMA,
        passes: float = PASSES,
    ) -> np.ndarray:
        """Smooth a picture (H, W) float32, see `Trials.after`; constants: see `TemporalFfx`."""
        return self.after(visibility, surface, sigma, passes)


class TemporalFfx:
    """The filter for a sequence of frames (height, width), given one by one.

    The history is the output of a frame's first pass. Where all around is dark or lit it begins anew.
    With the variance over frames, as in print, two rays erred 2.2 times as much by their history as without it
    (12 sequences of moving cameras, lights and objects), with that of pixels 0.96 times. At rest this costs: after 8
    frames of one ray errors are 1.2 times those by the printed one, behind the SIGMA-like filter 1.3 times.

    Args:
        sigma: see SIGMA. passes: see PASSES. share: see SHARE. clamp: see CLAMP.
    """

    def __init__(
        self,
        height: int,
        width: int,
        sigma: float = SIGMA,
        passes: float = PASSES,
        share: float = SHARE,
        clamp: float = CLAMP,
    ):
        self._spatial = FfxFilter(height, width, sigma)
        self._passes, self._share, self._clamp = passes, share, clamp
        self._history = History()  # the picture, and its number of frames

    def next_frame(
        self, visibility: np.ndarray, surface: Surface, back: Reprojection | None = None
    ) -> np.ndarray:
        """The next frame's picture, (H, W) float32.

        Args:
            visibility: (H, W) float32 in [0, 1].
            back: to the frame before, None at first.
        """
        self._spatial.see(surface.depth_image(), surface.image(surface.n))
        mean, noise = self._spatial.neighbourhood(visibility)
        new = np.stack([visibility, np.ones_like(visibility)])
        share = np.ones_like(visibility)
        pixels, past = self._history.at(len(new), back)
        values = (image.ravel()[pixels] for image in (visibility, mean, noise))
        new.reshape(len(new), -1)[:, pixels], share.ravel()[pixels] = self._added(past, *values)
        begun = self._spatial.cleared()
        new[0, begun], new[1, begun] = visibility[begun], 1
        new[0], last = smooth(self._spatial, new[0], _NOISE * share * noise, self._passes)
        self._history.keep(new)
        return last.copy()  # of no pass it is the history

    def _added(
        self, past: np.ndarray, visibility: np.ndarray, mean: np.ndarray, noise: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Add a frame to the history: (2, m), in the order of `_history`; and the frame's share (m,).

        Args:
            past: (2, m). visibility: (m,) of the frame's rays; mean, noise: (m,), see `neighbourhood`.
        """
        picture, frames = past
        near = np.float32(self._clamp) * np.sqrt(noise)
        clamped = np.clip(picture, mean - near, mean + near)
        off = (picture - mean) / np.maximum(near, np.float32(1e-3))
        frames = (frames + 1) * np.exp(-off * off / _SURPRISE)
        share = self._share + (1 - self._share) * np.sqrt(np.maximum(1 - frames / _LASTING, 0))
        return np.stack([clamped + share * (visibility - clamped), frames]), share


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _fill_next(guides, light, spread, mixed, sharpness, step, next_light, next_spread):
    """One pass over mixed blocks: weighted means, squared weights for variances."""
    height, width = light.shape
    sharp, total, lights, spreads = np.empty((4, SIDE), np.float32)
    for y in range(height):
        for block in range(mixed.shape[1]):
            if not mixed[y, block]:
                continue
            begin, end = block * SIDE, min(block * SIDE + SIDE, width)
            _fill_sharpness(spread, y, begin, end, sharpness, sharp)
            for i in range(end - begin):  # assignments of slices compile longer: 9.5 s for 5.4
                total[i], lights[i], spreads[i] = 1, light[y, begin + i], spread[y, begin + i]
            for below in range(-1, 2):
                v = y + below * step
                if v < 0 or v >= height:
                    continue
                for across in range(-1, 2):
                    along = across * step
                    x, last = max(begin, -along), min(end, width - along)
                    if x >= last or (below == 0 and across == 0):
                        continue
                    share = _TAPS[abs(below)] * _TAPS[abs(across)]
                    _add_tap(
                        guides[:, y, x:last],
                        guides[:, v, x + along : last + along],
                        light[y, x:last],
                        light[v, x + along : last + along],
                        spread[v, x + along : last + along],
                        sharp[x - begin :],
                        share,
                        total[x - begin :],
                        lights[x - begin :],
                        spreads[x - begin :],
                    )
            for i in range(end - begin):
                next_light[y, begin + i] = lights[i] / total[i]
                next_spread[y, begin + i] = spreads[i] / (total[i] * total[i])


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _fill_sharpness(spread, y, begin, end, sharpness, sharp):
    """1 / (σ · standard deviation) of a block, the variance smoothed by a 3 × 3 Gaussian."""
    height, width = spread.shape
    above, below = max(0, y - 1), min(height - 1, y + 1)
    for x in range(begin, end):
        left, right = max(0, x - 1), min(width - 1, x + 1)
        corners = spread[above, left] + spread[above, right]
        corners += spread[below, left] + spread[below, right]
        sides = spread[above, x] + spread[below, x] + spread[y, left] + spread[y, right]
        smooth = (corners + 2 * sides + 4 * spread[y, x]) / 16
        sharp[x - begin] = sharpness / np.sqrt(smooth + _LEAST)


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _add_tap(guide, tap_guide, light, tap_light, tap_spread, sharp, share, total, lights, spreads):
    """Add a weighted run of taps.

    The weight is share · exp(−|Δl| / (σ s) − |Δz| / (σ_z z)) (n·n')³².
    """
    z, nx, ny, nz = guide[0], guide[1], guide[2], guide[3]
    z_, nx_, ny_, nz_ = tap_guide[0], tap_guide[1], tap_guide[2], tap_guide[3]
    none, tiny = np.float32(0), np.float32(1e-12)
    for i in range(len(light)):
        t = abs(light[i] - tap_light[i]) * sharp[i]
        t += abs(z[i] - z_[i]) / (SIGMA_DEPTH * z[i] + tiny)
        cosine = nx[i] * nx_[i] + ny[i] * ny_[i] + nz[i] * nz_[i]
        cosine = none if cosine < _ASLANT else cosine
        for _ in range(5):
            cosine *= cosine
        weight = share * decayed(t) * cosine
        total[i] += weight
        lights[i] += weight * tap_light[i]
        spreads[i] += weight * weight * tap_spread[i]
