"""Compressed values of a field.

Only those of crossed cells, as small differences. A value is a level, in sixteenths of a cell.
Signs come first, one bit for each vertex that differs from its neighbours' prediction; they
determine the crossed cells. For the vertices of these follow the levels less their prediction, a
plane through earlier ones (Lorenzo predictor, Ibarria et al. 2003, of second order). Both are
compressed by LZMA. The other vertices get the largest level.
"""

import lzma

import numpy as np
import torch
from numba import njit
from torch import Tensor

from neural_shadows.representations.distance_bricks.brick_layout import BrickLayout, lay_out
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.representations.packed_bits import pack_bits, unpack_bits

# Stanford dragon fitted at 256³ (pooled PSNR, a sixth of the pixels of 48 views): not quantised
# 42.6 dB; 24 levels a cell 42.1, 16 41.8, 12 41.4, 8 40.8.
LEVELS_PER_CELL = 16
MOST = 28  # levels on each side: 1.75 cells, beyond the vertices of a crossed cell

# Without contexts of earlier bytes and positions: 0.8 % fewer bytes for the dragon than LZMA's
# default.
FILTERS = [{"id": lzma.FILTER_LZMA2, "preset": 9 | lzma.PRESET_EXTREME, "lc": 0, "lp": 0, "pb": 0}]
# Offsets of a vertex to earlier ones: across a face, then across an edge of their cell.
EARLIER = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1))


def levels_of(distances: np.ndarray) -> np.ndarray:
    """Levels (count,) int8 in [−MOST, MOST) of distances in cells; level l is (l + 0.5) / 16."""
    steps = np.floor(np.asarray(distances, np.float64) * LEVELS_PER_CELL)
    return steps.clip(-MOST, MOST - 1).astype(np.int8)


def coded(layout: BrickLayout, levels: np.ndarray) -> dict[str, Tensor]:
    """Encode levels: `bricks`, `signs` and `levels`, each (n,) uint8."""
    inside = levels >= 0
    neighbours = _neighbours(layout)
    crossed = _vertices_of_crossed(layout, inside)
    sizes = np.where(inside, levels, -1 - levels)[crossed]
    bricks = torch.from_numpy(layout.grid >= 0).reshape(-1)
    unexpected = torch.from_numpy(_signs(inside, neighbours, False))
    differences = _sizes(sizes, inside, crossed, neighbours, False)
    return {
        "bricks": _compressed(pack_bits(bricks).numpy()),
        "signs": _compressed(pack_bits(unexpected).numpy()),
        "levels": _compressed(differences.view(np.uint8)),
    }


def decoded(tensors: dict[str, Tensor], size: int, solid: bool) -> tuple[BrickLayout, np.ndarray]:
    """Decode the layout of size³ bricks, and levels (count,) int8.

    Outside crossed cells they are −MOST or MOST − 1. Raises ValueError, KeyError or LZMAError
    for other tensors than those of `coded`.
    """
    bricks = unpack_bits(_expanded(tensors["bricks"]), size**3).view(size, size, size).numpy()
    layout = lay_out(bricks, solid)
    neighbours = _neighbours(layout)
    unexpected = unpack_bits(_expanded(tensors["signs"]), layout.count).numpy()
    inside = _signs(unexpected, neighbours, True)
    crossed = _vertices_of_crossed(layout, inside)
    differences = _expanded(tensors["levels"]).numpy().view(np.int8)
    if len(differences) != crossed.sum():
        raise ValueError(f"{len(differences)} levels, not {crossed.sum()}")
    sizes = np.full(layout.count, MOST - 1, np.int8)
    sizes[crossed] = _sizes(differences, inside, crossed, neighbours, True)
    if sizes.min(initial=0) < 0 or sizes.max(initial=0) >= MOST:
        raise ValueError("levels beyond their end")
    return layout, np.where(inside, sizes, -1 - sizes)


def _compressed(data: np.ndarray) -> Tensor:
    packed = lzma.compress(data.tobytes(), lzma.FORMAT_RAW, filters=FILTERS)
    return torch.frombuffer(bytearray(packed), dtype=torch.uint8)


def _expanded(data: Tensor) -> Tensor:
    whole = lzma.decompress(data.numpy().tobytes(), lzma.FORMAT_RAW, filters=FILTERS)
    return torch.from_numpy(np.frombuffer(bytearray(whole), np.uint8))


def _neighbours(layout: BrickLayout) -> np.ndarray:
    """Indices (count, 6) int32 of `EARLIER` neighbours; `count` for none."""
    across = BRICK * len(layout.grid) + 1
    ids = np.ravel_multi_index(tuple(layout.vertices.T), (across,) * 3)  # sorted
    neighbours = np.full((layout.count, len(EARLIER)), layout.count, np.int32)
    for number, (x, y, z) in enumerate(EARLIER):
        earlier = ids - (x * across + y) * across - z
        index = np.searchsorted(ids, earlier)  # below the end: all are before their own
        exists = ids[index] == earlier
        neighbours[exists, number] = index[exists]
    return neighbours


def _vertices_of_crossed(layout: BrickLayout, inside: np.ndarray) -> np.ndarray:
    """Mask (count,) bool of the vertices of crossed cells."""
    corners = inside[layout.table].reshape(-1, *[BRICK + 1] * 3)
    any_inside = all_inside = corners
    for axis in (1, 2, 3):
        low, high = range(BRICK), range(1, BRICK + 1)
        any_inside = any_inside.take(low, axis) | any_inside.take(high, axis)
        all_inside = all_inside.take(low, axis) & all_inside.take(high, axis)
    crossed = any_inside & ~all_inside
    for axis in (1, 2, 3):
        ends = [(0, 0)] * 4
        crossed = np.pad(crossed, [*ends[:axis], (1, 0), *ends[axis + 1 :]]) | np.pad(
            crossed, [*ends[:axis], (0, 1), *ends[axis + 1 :]]
        )
    near = np.zeros(layout.count, bool)
    near[layout.table[crossed.reshape(layout.table.shape)]] = True
    return near


@njit(cache=True, nogil=True)
def _expected(values, around):
    """Prediction by a plane: the mean of three parallelograms' fourth corners."""
    faces = np.int64(values[around[0]]) + values[around[1]] + values[around[2]]
    edges = np.int64(values[around[3]]) + values[around[4]] + values[around[5]]
    return (2 * faces - edges) // 3


@njit(cache=True, nogil=True)
def _signs(source, neighbours, decoding):
    """Encode inside flags as unexpected signs, or decode them."""
    count = len(source)
    result = np.empty(count, np.bool_)
    signs = np.empty(count + 1, np.int8)
    signs[count] = -1
    for vertex in range(count):
        result[vertex] = source[vertex] != (_expected(signs, neighbours[vertex]) >= 0)
        inside = result[vertex] if decoding else source[vertex]
        signs[vertex] = 1 if inside else -1
    return result


@njit(cache=True, nogil=True)
def _sizes(source, inside, near, neighbours, decoding):
    """Encode near vertices' absolute levels as differences, or decode them."""
    count = len(inside)
    result = np.empty(len(source), np.int8)
    levels = np.empty(count + 1, np.int8)
    levels[count] = -MOST
    number = 0
    for vertex in range(count):
        size = MOST - 1
        if near[vertex]:
            expected = _expected(levels, neighbours[vertex])
            expected = min(max(expected if inside[vertex] else -1 - expected, 0), MOST - 1)
            result[number] = source[number] + expected if decoding else source[number] - expected
            size = result[number] if decoding else source[number]
            number += 1
        levels[vertex] = size if inside[vertex] else -1 - size
    return result
