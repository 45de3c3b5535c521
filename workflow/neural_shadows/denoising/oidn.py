"""Intel Open Image Denoise, a trained network, on pictures of visibility.

By the package `pyoidn`, for x86-64 alone. Its filter RT, with normals and albedo beside the colours:
for those in [0, 1], or for those of any range, as renderers feed it. Visibility has no albedo; depths take its
place, their logarithm from 0 to 1: of two and of four rays 1 to 4 % less error off edges than with 1 on all
surfaces, at three lights (validation frames of `windows`; linear depths 1 to 3 %).
"""

from functools import cache

import numpy as np

from neural_shadows.errors import InputError

# The library's "balanced" is the same network as "high" for colours in [0, 1] (2.5.1 has no larger one
# for them).
QUALITIES = ("high", "fast")
ANY_RANGE = 0.0  # in the place of full light's value: the network for colours of any range


def open_image_denoise(
    visibility: np.ndarray,
    normal: np.ndarray,
    depth: np.ndarray,
    *,
    quality: str = "high",
    light: float = ANY_RANGE,
) -> np.ndarray:
    """Denoise a picture, (H, W) float32 in [0, 1], on one thread.

    Args:
        visibility: (H, W) float32 in [0, 1].
        normal: (H, W, 3) float32, unit, noise-free; 0 where there is no surface.
        depth: (H, W) float32, positive on surfaces.
        quality: one of QUALITIES.
        light: the value of full light for the network of colours in [0, 1]. It takes 1 for any brightness
            clipped at 1, and so fills penumbrae with light: at one ray a pixel of a room, a mean squared
            error of 0.031 became 0.006 with 0.5. `ANY_RANGE` is the network that finds the exposure by
            itself; of one ray it left 0.3 to 0.8 times the error of 0.5 in five of six frames.

    Raises:
        InputError: the package is not installed.
        RuntimeError: an error of the library.
    """
    return _network(*visibility.shape, quality, light == ANY_RANGE)(
        visibility, normal, _shares(depth, normal.any(-1)), light or 1.0
    )


def _shares(depth: np.ndarray, surface: np.ndarray) -> np.ndarray:
    """Logarithms of depths on surfaces, from 0 of the nearest to 1 of the farthest; elsewhere 0."""
    logs = np.log(depth, out=np.zeros_like(depth), where=surface)
    nearest = logs.min(where=surface, initial=np.inf)
    farthest = logs.max(where=surface, initial=-np.inf)
    return np.where(surface, (logs - nearest) / max(farthest - nearest, 1e-6), np.float32(0))


def _package():
    try:
        import pyoidn
    except ImportError:
        raise InputError(
            "Open Image Denoise is not installed (pyoidn, for x86-64 alone). Leave out the methods "
            "rt_N_oidn."
        ) from None
    return pyoidn


@cache
def _device():
    """A CPU device of one thread, for the process's lifetime."""
    device = _package().Device()
    device.set_int("numThreads", 1)
    # Threads that are bound to cores would stay on those of other processes.
    device.set_bool("setAffinity", False)
    device.commit()
    _check(device)
    return device


def _check(device) -> None:
    message = device.get_error()
    if message:
        raise RuntimeError(f"Open Image Denoise: {message}")


class _Network:
    """The network for pictures of one size, and its buffers."""

    def __init__(self, height: int, width: int, quality: str, hdr: bool):
        oidn = _package()
        self.device = _device()
        names = (
            oidn.OIDN_IMAGE_COLOR,
            oidn.OIDN_IMAGE_ALBEDO,
            oidn.OIDN_IMAGE_NORMAL,
            oidn.OIDN_IMAGE_OUTPUT,
        )
        buffers = np.zeros((len(names), height, width, 3), np.float32)
        self.colour, self.albedo, self.normal, self.output = buffers
        self.filter = oidn.Filter(self.device, oidn.OIDN_FILTER_TYPE_RT)
        for name, buffer in zip(names, buffers):
            self.filter.set_image(name, buffer, oidn.OIDN_FORMAT_FLOAT3)
        self.filter.set_bool("hdr", hdr)
        # Normals at pixels' centres are free of noise, but have steps, unlike a target of several
        # places in a pixel: without keeping their edges as they are errors were 20 to 45 % smaller.
        self.filter.set_bool("cleanAux", False)
        self.filter.set_quality(getattr(oidn, f"OIDN_QUALITY_{quality.upper()}"))
        self.filter.commit()
        _check(self.device)

    def __call__(
        self, visibility: np.ndarray, normal: np.ndarray, albedo: np.ndarray, light: float
    ) -> np.ndarray:
        np.multiply(visibility[..., None], np.float32(light), out=self.colour)
        self.normal[:] = normal
        self.albedo[:] = albedo[..., None]
        self.filter.execute()
        _check(self.device)
        return np.clip(self.output.mean(-1) / np.float32(light), 0, 1)


_network = cache(_Network)
