"""Whether VTK can draw on this machine; where it cannot, it would crash its process."""

import ctypes
import sys
from functools import cache

MISSING = (
    "figures in three dimensions need OpenGL, which is not found: install it "
    "(apt-get install libosmesa6 on Debian and Ubuntu, dnf install mesa-libEGL on Fedora)"
)
_OSMESA = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")  # as VTK 9.7 tries them
_PLATFORM_DEVICE = 0x313F  # EGL_PLATFORM_DEVICE_EXT


def available() -> bool:
    """Whether figures in three dimensions can be drawn here: 40 ms, and VTK is not loaded."""
    return window_class() is not None


@cache
def window_class() -> str | None:
    """The class of VTK 9.7 that draws off screen here: "" for its default, None for none.

    A display is left out of account: a forwarded one may draw nothing, and where one does draw,
    EGL is installed too.
    """
    if sys.platform != "linux":
        return ""  # OpenGL is part of the system
    if _egl_starts():
        return "vtkEGLRenderWindow"
    return "vtkOSOpenGLRenderWindow" if any(map(_load, _OSMESA)) else None


def _load(name: str) -> ctypes.CDLL | None:
    try:
        return ctypes.CDLL(name)
    except OSError:
        return None


def _egl_starts() -> bool:
    """Whether a device of EGL starts; the library alone may have none, or no driver for it."""
    pointer, number = ctypes.c_void_p, ctypes.c_int
    if (egl := _load("libEGL.so.1")) is None:
        return False
    egl.eglGetProcAddress.restype = pointer
    egl.eglInitialize.argtypes = [pointer] * 3
    egl.eglTerminate.argtypes = [pointer]
    query = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    display_of = egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
    if not query or not display_of:
        return False
    devices, count = (pointer * 16)(), number()
    ctypes.CFUNCTYPE(number, number, pointer, pointer)(query)(16, devices, ctypes.byref(count))
    for device in devices[: count.value]:
        call = ctypes.CFUNCTYPE(pointer, number, pointer, pointer)(display_of)
        display = call(_PLATFORM_DEVICE, device, None)
        if display and egl.eglInitialize(display, None, None):
            egl.eglTerminate(display)
            return True
    return False
