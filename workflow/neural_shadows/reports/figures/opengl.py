"""Whether VTK can draw on this machine; where it cannot, it would crash its process."""

import ctypes
import sys
from functools import cache

MISSING = (
    "the figures in three dimensions need OpenGL, which this machine does not have: install it "
    "(apt-get install libosmesa6 on Debian and Ubuntu, dnf install mesa-libEGL on Fedora)"
)
_MOST_DEVICES = 16
_PLATFORM_DEVICE = 0x313F  # EGL_PLATFORM_DEVICE_EXT


@cache
def window_class() -> str | None:
    """The class of VTK 9.7 that draws off screen here: "" for its default, None for none.

    A display is left out of account: a forwarded one may draw nothing, and one that does stands
    on a machine that has EGL too. 40 ms, and VTK is not loaded.
    """
    if sys.platform != "linux":
        return ""  # OpenGL is part of the system
    if _egl_starts():
        return "vtkEGLRenderWindow"
    return "vtkOSOpenGLRenderWindow" if _osmesa_loads() else None


def available() -> bool:
    """Whether figures in three dimensions can be drawn here."""
    return window_class() is not None


def _osmesa_loads() -> bool:
    for name in ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"):  # as VTK tries them
        try:
            ctypes.CDLL(name)
        except OSError:
            continue
        return True
    return False


def _egl_starts() -> bool:
    """Whether a device of EGL starts; the library alone may have none, or no driver for it."""
    pointer, number = ctypes.c_void_p, ctypes.c_int
    try:
        egl = ctypes.CDLL("libEGL.so.1")
    except OSError:
        return False
    egl.eglGetProcAddress.restype = pointer
    egl.eglInitialize.argtypes = [pointer] * 3
    egl.eglTerminate.argtypes = [pointer]
    query, display_of = map(
        egl.eglGetProcAddress, (b"eglQueryDevicesEXT", b"eglGetPlatformDisplayEXT")
    )
    if not query or not display_of:
        return False
    query = ctypes.CFUNCTYPE(number, number, pointer, pointer)(query)
    display_of = ctypes.CFUNCTYPE(pointer, number, pointer, pointer)(display_of)
    devices, count = (pointer * _MOST_DEVICES)(), number()
    query(_MOST_DEVICES, devices, ctypes.byref(count))
    for device in devices[: count.value]:
        display = display_of(_PLATFORM_DEVICE, device, None)
        if display and egl.eglInitialize(display, None, None):
            egl.eglTerminate(display)
            return True
    return False
