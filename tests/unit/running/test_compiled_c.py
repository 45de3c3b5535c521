"""C at first use: compiled once, and where it cannot be, one warning."""

import os
import subprocess
import sys

import pytest

from neural_shadows.running.compiled_c import compiled_c

THREE = "int three(void) { return 3; }"


@pytest.fixture
def source(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "three.c"
    path.write_text(THREE)
    compiled_c.cache_clear()
    yield path
    compiled_c.cache_clear()


def no_compiler(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))


def test_a_function_is_compiled_once(source, tmp_path, monkeypatch):
    library = compiled_c(source)
    if library is None:
        pytest.skip("no C compiler: apt-get install gcc")
    assert library.three() == 3
    (path,) = (tmp_path / "cache").iterdir()
    written = path.stat().st_mtime_ns
    compiled_c.cache_clear()
    assert compiled_c(source).three() == 3 and path.stat().st_mtime_ns == written
    source.write_text(THREE.replace("3", "4"))
    compiled_c.cache_clear()
    assert compiled_c(source).three() == 4 and len(list((tmp_path / "cache").iterdir())) == 2


def test_without_a_compiler_there_is_one_warning(source, tmp_path, monkeypatch):
    no_compiler(tmp_path, monkeypatch)
    with pytest.warns(RuntimeWarning, match="three.c: not compiled: no gcc or cc.") as warnings:
        assert compiled_c(source) is None and compiled_c(source) is None
    assert len(warnings) == 1


def test_what_does_not_compile_is_warned_of(source, tmp_path):
    source.write_text("int three(void) { return }")
    with pytest.warns(RuntimeWarning, match="three.c: not compiled: "):
        assert compiled_c(source) is None
    assert list((tmp_path / "cache").iterdir()) == []


def test_a_folder_that_cannot_be_written_is_passed_over(source, tmp_path, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    (tmp_path / "__pycache__").write_text("a file")
    library = compiled_c(source)
    if library is None:
        pytest.skip("no C compiler: apt-get install gcc")
    assert library.three() == 3 and list((tmp_path / "home" / "neural_shadows").iterdir())


WITHOUT = """
import numpy as np, trimesh
from neural_shadows import ShadowField
field = ShadowField.fit(trimesh.creation.icosphere(3), resolution=32)
points = np.tile([[0.0, 0, 0], [0, 0, 3]], (10_000, 1))  # few are answered one by one
print(field.occluded(points, [0, 0, 1])[:2].tolist())
"""


def test_a_field_answers_without_a_compiler(tmp_path):
    """A machine whose PATH has no gcc."""
    environment = dict(os.environ, PATH=str(tmp_path), PYTHONPATH=os.pathsep.join(sys.path))
    command = [sys.executable, "-W", "always", "-c", WITHOUT]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.stdout == "[True, False]\n", done.stderr
    assert done.stderr.count("field_occlusion.c: not compiled: no gcc or cc.") == 1
