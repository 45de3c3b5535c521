"""Saved fields: the same answers when loaded, and one line for any other file."""

import numpy as np
import pytest
from safetensors.numpy import load, save
from shapes import bumpy_sphere, sheet

from neural_shadows import InputError, ShadowField
from neural_shadows.representations.shadow_field.field_file import FORMAT, VERSION

HEADER = {"format": f"{FORMAT} {VERSION}"}
LIGHT = np.array([1.0, 2.0, 0.5])


@pytest.fixture(scope="module")
def field():
    return ShadowField.fit(bumpy_sphere(3), resolution=64)


@pytest.mark.parametrize("open_mesh", [False, True])
def test_a_loaded_field_is_the_saved_one(tmp_path, field, open_mesh):
    if open_mesh:
        field = ShadowField.fit(sheet(0.2, 0.7), resolution=64)
    field.save(tmp_path / "a.field")
    loaded = ShadowField.load(tmp_path / "a.field")
    assert loaded.sheet == open_mesh
    for name in ("centre", "bricks", "cells", "radius"):
        assert np.array_equal(getattr(loaded, name), getattr(field, name)), name
    assert np.array_equal(loaded.grid >= 0, field.grid >= 0)
    points = np.random.default_rng(0).uniform(-1, 1, (20_000, 3))
    assert np.array_equal(loaded.occluded(points, LIGHT), field.occluded(points, LIGHT))
    assert np.array_equal(loaded.soft(points, LIGHT, 3), field.soft(points, LIGHT, 3))
    loaded.save(tmp_path / "b.field")
    assert (tmp_path / "a.field").read_bytes() == (tmp_path / "b.field").read_bytes()


def changed(content: bytes, **arrays) -> bytes:
    return save({**load(content), **arrays}, HEADER)


OTHERS = {
    "empty": (lambda content: b"", "cannot be read"),
    "cut off": (lambda content: content[:-1000], "cannot be read"),
    "cut in its header": (lambda content: content[:50], "cannot be read"),
    "text": (lambda content: b"solid\nfacet normal 0 0 1\n" * 20, "cannot be read"),
    "foreign": (lambda content: save({"weights": np.zeros(3)}), "not a saved ShadowField"),
    "another version": (
        lambda content: save(load(content), {"format": f"{FORMAT} 2"}),
        "version 2 of the format, not 1. Save it again",
    ),
    "fewer bricks": (
        lambda content: changed(content, bricks=np.zeros((3, 125), np.int8)),
        r"damaged \(bricks is \(3, 125\), not",
    ),
    "an empty grid": (
        lambda content: changed(
            content,
            grid=np.zeros((0, 0, 0), np.uint8),
            bricks=np.zeros((0, 125), np.int8),
            cells=np.zeros(0, np.uint64),
        ),
        r"damaged \(grid is \(0, 0, 0\), not \(1, 1, 1\)\)",
    ),
    "another type": (
        lambda content: changed(content, bricks=load(content)["bricks"].astype(np.float32)),
        r"damaged \(bricks is float32",
    ),
    "no radius": (
        lambda content: changed(content, radius=np.array([np.nan])),
        "no finite centre and radius",
    ),
    "a part is missing": (
        lambda content: save({"grid": load(content)["grid"]}, HEADER),
        r"damaged \(no bricks\)",
    ),
}


@pytest.mark.parametrize("name", OTHERS)
def test_other_files_are_refused_in_one_line(tmp_path, field, name):
    change, message = OTHERS[name]
    path = tmp_path / "some.field"
    field.save(path)
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(InputError, match=rf"some\.field: .*{message}") as error:
        ShadowField.load(path)
    assert "\n" not in str(error.value)


def test_no_file(tmp_path):
    with pytest.raises(InputError, match="none.field: cannot be read"):
        ShadowField.load(tmp_path / "none.field")


def test_an_older_file_stays_if_the_disk_is_full(tmp_path, field, monkeypatch):
    path = tmp_path / "a.field"
    field.save(path)
    before = path.read_bytes()

    def full(self, content):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_bytes", full)
    with pytest.raises(OSError, match="a.field"):
        field.save(path)
    assert path.read_bytes() == before and [*tmp_path.iterdir()] == [path]
