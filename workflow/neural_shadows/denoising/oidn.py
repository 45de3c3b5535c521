"""Intel Open Image Denoise, a trained network, on pictures of visibility.

By the package `pyoidn`, for x86-64 alone. Its filter RT, with normals and albedo beside the colours:
for those in [0, 1], or for those of any range, as renderers feed it.
"""

from functools import cache

import numpy as np

from neural_shadows.errors import InputError

# The library's "balanced" is the same network as "high" for colours in [0, 1] (2.5.1 has no larger one
# for them).
QUALITIES = ("high", "fast")
# Value of full light for the network of colours in [0, 1]: it takes 1 for any brightness clipped at 1, and so
# fills penumbrae with light. At 1 ray a pixel of a room, a mean squared error of 0.031 became 0.006.
# That of any range finds the exposure by itself.
BRIGHTNESS = {False: np.float32(0.5), True: np.float32(1)}


def open_image_denoise(
    visibility: np.ndarray, normal: np.ndarray, *, quality: str = "high", hdr: bool = True
) -> np.ndarray:
    """Denoise a picture, (H, W) float32 in [0, 1], on one thread.

    Args:
        visibility: (H, W) float32 in [0, 1].
        normal: (H, W, 3) float32, unit, noise-free; 0 where there is no surface.
        quality: one of QUALITIES. hdr: by the network for colours of any range. Of one ray it
            left 0.3 to 0.8 times the error of the other in five of six frames, of four about the same.

    Raises:
        InputError: the package is not installed.
        RuntimeError: an error of the library.
    """
    return _network(*visibility.shape, quality, hdr)(visibility, normal)


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
        self.brightness = BRIGHTNESS[hdr]
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

    def __call__(self, visibility: np.ndarray, normal: np.ndarray) -> np.ndarray:
        np.multiply(visibility[..., None], self.brightness, out=self.colour)
        self.normal[:] = normal
        self.albedo[:] = normal.any(-1)[..., None]
        self.filter.execute()
        _check(self.device)
        return np.clip(self.output.mean(-1) / self.brightness, 0, 1)


_network = cache(_Network)
