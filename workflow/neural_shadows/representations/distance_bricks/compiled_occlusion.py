"""`field_occlusion.c`, called with numpy arrays."""

import ctypes
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from neural_shadows.representations.distance_bricks.field_bricks import FieldBricks
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.representations.distance_bricks.light_tables import LightTables
from neural_shadows.running.compiled_c import compiled_c

_INT, _FLOAT, _ADDRESS = ctypes.c_int32, ctypes.c_float, ctypes.c_void_p
_THREE = _FLOAT * 3


class _Field(ctypes.Structure):
    """`Field` of field_occlusion.c."""

    _fields_ = [
        ("sheet", _INT),
        ("density", _INT),
        ("columns", _INT),
        ("layers", _INT),
        ("shape", _INT * 3),
        ("row_bytes", _INT),
        ("word_bytes", _INT),
        ("scale", _FLOAT),
        ("shift", _THREE),
        *((name, _ADDRESS) for name in ("nodes", "rows", "masks", "first", "words")),
    ]


class _Light(ctypes.Structure):
    """`Light` of field_occlusion.c."""

    _fields_ = [
        ("merged", _INT),
        ("axes", _INT * 3),
        ("back", _INT),
        ("near", _INT),
        ("deep", _INT),
        ("rows", _INT),
        ("low", _INT * 2),
        ("middle", _INT * 2),
        ("source", ctypes.c_double * 3),
        *((name, _ADDRESS) for name in ("offsets", "ends", "ranges", "slabs")),
    ]


@cache
def compiled_occlusion() -> Callable[..., None] | None:
    """`mark_occluded` in C, with the arguments of the one in Numba; None without a compiler."""
    library = compiled_c(Path(__file__).with_name("field_occlusion.c"))
    return library and marking(library)


def marking(library: ctypes.CDLL) -> Callable[..., None]:
    """`mark_occluded` of a compiled field_occlusion.c."""
    function = library.mark_occluded
    function.argtypes = [_ADDRESS, _ADDRESS, _ADDRESS, ctypes.c_int64, _FLOAT, _ADDRESS]
    function.restype = _INT

    def mark_occluded(points, light, bricks, bias, occlusion) -> None:
        field, tables = _field(bricks, BRICK >> light.merged), _light(light)
        arrays = points.ctypes.data, len(points), bias, occlusion.ctypes.data
        if function(ctypes.addressof(field), ctypes.addressof(tables), *arrays):
            raise MemoryError("field_occlusion.c: no memory for its samples")

    return mark_occluded


def _field(bricks: FieldBricks, brick: int) -> _Field:
    """Args: brick: blocks along one."""
    half = brick * bricks.size / 2
    return _Field(
        bricks.sheet,
        bricks.density,
        *bricks.nodes.shape[1:],
        (_INT * 3)(*bricks.shape),
        bricks.rows.itemsize,
        bricks.words.itemsize,
        half,
        _THREE(*(half - brick * bricks.corner)),
        *map(_address, (bricks.nodes, bricks.rows, bricks.masks, bricks.first, bricks.words)),
    )


def _light(light: LightTables) -> _Light:
    return _Light(
        light.merged,
        (_INT * 3)(*light.axes),
        light.back,
        light.near,
        light.deep,
        len(light.offsets),
        (_INT * 2)(*light.low),
        (_INT * 2)(*light.middle),
        (ctypes.c_double * 3)(*light.source),
        *map(_address, (light.offsets, light.ends, light.ranges, light.slabs)),
    )


def _address(array: np.ndarray) -> int:
    assert array.flags.c_contiguous
    return array.ctypes.data
