"""Intel Open Image Denoise, a trained network, on pictures of visibility.

By the package `pyoidn`, for x86-64 alone. Its filter RT for colours in [0, 1], with
normals and albedo beside them.
"""

from functools import cache

import numpy as np

from neural_shadows.errors import InputError

# "balanced" is the same network as "high" for colours in [0, 1] (2.5.1 has no larger one for them).
QUALITIES = ("high", "balanced", "fast")
# Value of full light: the network takes 1 for any brightness clipped at 1, and so
# fills penumbrae with light. At 1 ray a pixel of a room, a mean squared error of 0.031 became 0.006.
BRIGHTNESS = np.float32(0.5)


def open_image_denoise(
    visibility: np.ndarray,
    normal: np.ndarray,
    *,
    quality: str = "high",
    clean: bool = False,
    threads: int = 1,
) -> np.ndarray:
    """Denoise a picture, (H, W) float32 in [0, 1].

    Args:
        visibility: (H, W) float32 in [0, 1].
        normal: (H, W, 3) float32, unit, noise-free; 0 where there is no surface.
        quality: one of QUALITIES. threads: of the network.
        clean: `cleanAux`, keep the normals' edges as they are. Those at pixels' centres are free
            of noise, but have steps, unlike a target of several places in a pixel: without it
            errors were 20 to 45 % smaller.

    Raises:
        InputError: the package is not installed.
        RuntimeError: an error of the library.
    """
    return _network(*visibility.shape, quality, clean, threads)(visibility, normal)


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
def _device(threads: int):
    """A CPU device for the process's lifetime."""
    device = _package().Device()
    device.set_int("numThreads", threads)
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

    def __init__(self, height: int, width: int, quality: str, clean: bool, threads: int):
        oidn = _package()
        self.device = _device(threads)
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
        self.filter.set_bool("hdr", False)
        self.filter.set_bool("cleanAux", clean)
        self.filter.set_quality(getattr(oidn, f"OIDN_QUALITY_{quality.upper()}"))
        self.filter.commit()
        _check(self.device)

    def __call__(self, visibility: np.ndarray, normal: np.ndarray) -> np.ndarray:
        np.multiply(visibility[..., None], BRIGHTNESS, out=self.colour)
        self.normal[:] = normal
        self.albedo[:] = normal.any(-1)[..., None]
        self.filter.execute()
        _check(self.device)
        return np.clip(self.output.mean(-1) / BRIGHTNESS, 0, 1)


_network = cache(_Network)
