import ctypes
import sys
from unittest.mock import MagicMock

import pytest
from shapes import Y_UP

from neural_shadows.errors import InputError
from neural_shadows.reports.figures import opengl
from neural_shadows.reports.figures.hero_view import hero_view
from neural_shadows.reports.figures.space import new_plotter

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="OpenGL is part of the system")


@pytest.fixture(autouse=True)
def forget():
    opengl.window_class.cache_clear()
    yield
    opengl.window_class.cache_clear()


def libraries(monkeypatch, *names, found="a library"):
    monkeypatch.setattr(opengl, "_load", lambda name: found if name in names else None)


def test_without_libraries_a_figure_says_what_to_install(monkeypatch):
    libraries(monkeypatch)
    assert not opengl.available()
    with pytest.raises(InputError, match="libosmesa6"):
        new_plotter(hero_view(Y_UP))


def test_osmesa_is_enough(monkeypatch):
    libraries(monkeypatch, "libOSMesa.so.6")
    assert opengl.window_class() == "vtkOSOpenGLRenderWindow"


def test_egl_without_a_device_is_not(monkeypatch):
    # eglQueryDevicesEXT succeeds and leaves the count at 0, as without a driver.
    prototype = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
    query = prototype(lambda *_: 1)
    egl = MagicMock()
    egl.eglGetProcAddress.return_value = ctypes.cast(query, ctypes.c_void_p).value
    libraries(monkeypatch, "libEGL.so.1", found=egl)
    assert not opengl.available()
    egl.eglInitialize.assert_not_called()
