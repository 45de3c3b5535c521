import ctypes
import sys
from unittest.mock import MagicMock

import pytest

from neural_shadows.reports.drawing import opengl

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="OpenGL is part of the system")


@pytest.mark.parametrize("name", ["libOSMesa.so.6", "libEGL.so.1", None])
def test_egl_without_a_device_is_not_enough_and_osmesa_is(monkeypatch, name):
    # eglQueryDevicesEXT succeeds and leaves the count at 0, as without a driver.
    prototype = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
    query, library = prototype(lambda *_: 1), MagicMock()
    library.eglGetProcAddress.return_value = ctypes.cast(query, ctypes.c_void_p).value
    monkeypatch.setattr(opengl, "_load", {name: library}.get)
    expected = "vtkOSOpenGLRenderWindow" if name == "libOSMesa.so.6" else None
    assert opengl.find_window() == expected
    library.eglInitialize.assert_not_called()
