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


@pytest.fixture
def libraries(monkeypatch):
    def libraries(*names, found="a library"):
        opengl.window_class.cache_clear()
        monkeypatch.setattr(opengl, "_load", lambda name: found if name in names else None)

    yield libraries
    opengl.window_class.cache_clear()


def test_without_libraries_a_figure_says_what_to_install(libraries):
    libraries()
    assert not opengl.available()
    with pytest.raises(InputError, match="libosmesa6"):
        new_plotter(hero_view(Y_UP))
    libraries("libOSMesa.so.6")
    assert opengl.window_class() == "vtkOSOpenGLRenderWindow"


def test_egl_without_a_device_is_not_enough(libraries):
    # eglQueryDevicesEXT succeeds and leaves the count at 0, as without a driver.
    prototype = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
    query = prototype(lambda *_: 1)
    egl = MagicMock()
    egl.eglGetProcAddress.return_value = ctypes.cast(query, ctypes.c_void_p).value
    libraries("libEGL.so.1", found=egl)
    assert not opengl.available()
    egl.eglInitialize.assert_not_called()
