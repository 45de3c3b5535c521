"""Availability of OpenGL; without it VTK crashes its process."""

import ctypes
import subprocess
import sys
from functools import cache

MISSING = (
    "figures in 3D need OpenGL, which is not found. Install it "
    "(apt-get install libosmesa6 on Debian and Ubuntu, dnf install mesa-libEGL on Fedora)"
)
_OSMESA = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")  # as VTK 9.7 tries them
_PLATFORM_DEVICE = 0x313F  # EGL_PLATFORM_DEVICE_EXT


def available() -> bool:
    """Check for OpenGL: takes 60 ms, without loading VTK."""
    return window_class() is not None


@cache
def window_class() -> str | None:
    """The class of VTK 9.7 for drawing off screen.

    "" is its default, None none. Displays are not considered: a forwarded one may draw nothing, and
    where one draws, EGL is installed too.
    """
    if sys.platform != "linux":
        return ""  # OpenGL is part of the system
    # In a process of its own: a driver's LLVM, once loaded, makes a later `import triton` crash.
    command = [sys.executable, "-I", "-S", __file__]
    return subprocess.run(command, capture_output=True, text=True).stdout.strip() or None


def find_window() -> str | None:
    """The `window_class` on Linux, tried in this process."""
    if _egl_starts():
        return "vtkEGLRenderWindow"
    return "vtkOSOpenGLRenderWindow" if any(map(_load, _OSMESA)) else None


def _load(name: str) -> ctypes.CDLL | None:
    try:
        return ctypes.CDLL(name)
    except OSError:
        return None


def _egl_starts() -> bool:
    """Initialise an EGL device; the library alone is not enough."""
    pointer, number = ctypes.c_void_p, ctypes.c_int
    if (egl := _load("libEGL.so.1")) is None:
        return False
    egl.eglGetProcAddress.restype = pointer
    egl.eglInitialize.argtypes = [pointer] * 3
    query = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    display_of = egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
    if not query or not display_of:
        return False
    devices, count = (pointer * 16)(), number()
    ctypes.CFUNCTYPE(number, number, pointer, pointer)(query)(16, devices, ctypes.byref(count))
    display_of = ctypes.CFUNCTYPE(pointer, number, pointer, pointer)(display_of)
    displays = [display_of(_PLATFORM_DEVICE, device, None) for device in devices[: count.value]]
    return any(display and egl.eglInitialize(display, None, None) for display in displays)


if __name__ == "__main__":
    print(find_window() or "")
